# What a diagram is warned of when it is loaded is in its record, and is told again by a run of that.
quiet="--no-progress --log-level off"
"$SIMULATOR" run "$OCA_SOURCE/diagrams/static_test.yaml" -t 0.1 $quiet --record a.mcap > out 2> first || [ $? = 3 ]
grep -q 'warning: systems.relaxation: the loop must chatter' first
"$SIMULATOR" run a.mcap $quiet --record b.mcap > out 2> second || [ $? = 3 ]
"$SIMULATOR" run b.mcap $quiet > out 2> third || [ $? = 3 ]
diff first second
diff first third
# Another diagram has other warnings.
"$SIMULATOR" run a.mcap -s parameters.relaxation_time=0.4 $quiet > out 2> calm || [ $? = 3 ]
[ ! -s calm ] || { cat calm; exit 1; }
