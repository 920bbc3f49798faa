# A goal that was not measured is never met: commands that fail, that print no number, or nothing.
cat > goals.csv <<'G'
# a comment
good;1;<= 3;m;q;within;echo 3
equal;1;= 0;;q;none;echo 0.0
more;1;>= 97;%;q;enough;echo 97.5
over;1;<= 3;m;q;beyond;echo 3.01
noisy;1;<= 3;m;q;the last line counts;printf 'first 9\n2\n'
fails;1;<= 3;m;q;status;echo 1 && false
broken_pipe;1;<= 3;m;q;status of any part;false | echo 1
silent;1;<= 3;m;q;nothing;true
words;1;<= 3;m;q;no number;echo nan
slow;1;<= 3;m;;left out by --quick;echo 1
G
status=0
OCA_GOALS=$PWD/goals.csv OCA_BUILD=$OCA_BUILD "$OCA_SOURCE/tools/scoreboard.sh" --quick > out || status=$?
cat out
[ $status -eq 1 ]
verdict() { awk -F' *[|] *' -v id="$1" '$2 == id { print $6 }' out; }
for id in good equal more noisy; do [ "$(verdict $id)" = met ]; done
[ "$(verdict over)" = MISSED ]
for id in fails broken_pipe silent words; do [ "$(verdict $id)" = 'not measured' ]; done
[ -z "$(verdict slow)" ]
[ "$(tail -n 1 out)" = '4 met, 1 missed, 4 not measured' ]

OCA_GOALS=$PWD/goals.csv OCA_BUILD=$OCA_BUILD "$OCA_SOURCE/tools/scoreboard.sh" '^(good|slow)$' > out
[ "$(tail -n 1 out)" = '2 met, 0 missed, 0 not measured' ]
