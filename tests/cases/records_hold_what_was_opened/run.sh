# A record takes along what the run read: the mesh whose name has an entity, none of a comment or of
# another tool, no file beside the parts, not even one that a parameter could choose.
cp "$CASE"/* .
cp -r "$OCA_SOURCE/diagrams/parts" parts
for name in avoidance_secret other; do echo '# password: hunter2' > parts/$name.yaml; done
run() {
  "$SIMULATOR" run "$@" --no-progress > /dev/null 2> err || { echo "$*"; cat err; exit 1; }
}
run d.yaml --record a.mcap --record-compression none --report a.html
! grep -q hunter2 a.mcap || { echo 'a secret was taken'; exit 1; }
mkdir away
mv a.mcap away
rm -r parts arm.urdf *.stl d.yaml
cd away
run a.mcap --record b.mcap
"$SIMULATOR" compare a.mcap b.mcap > difference || { cat difference; exit 1; }
# The parts of OCA can be chosen from the record alone, and from that of its replay.
run a.mcap -s parameters.avoidance=report --record c.mcap
run c.mcap -s parameters.avoidance=safety_filter --record d.mcap
"$SIMULATOR" compare a.mcap d.mcap > difference || { cat difference; exit 1; }
