# What is run from a record reads what came with it and packages, whatever it names.
command -v node > /dev/null || { echo 'no node: nothing to make the records with'; exit 0; }
printf 'x,y,z\n1.25,2.5,3.75\n' > private.csv
echo 'parameters: {word: hunter2}' > private.yaml
here=$PWD
cloud() { echo "systems: {o: {type: ObstacleSource, obstacles: [{id: a, pose: {xyz: [0, 0, 0]}, shape: {type: cloud, file: $1, radius: 0.1}}]}}"; }
refuse() {  # ATTACHMENT...
  node "$CASE/make.js" stranger.mcap "$@"
  status=0
  "$SIMULATOR" run stranger.mcap -t 0.1 --record answer.mcap --record-compression none > out 2> err || status=$?
  [ $status = 2 ] && grep -q 'outside of the record' err && [ ! -e answer.mcap ] && return
  echo "$*: status $status"; cat err; exit 1
}
short='simulator: {duration: 0.1}'
refuse "diagram.yaml=$(cloud "$here/private.csv")
$short"
refuse "diagram.yaml=$(cloud "../..$here/private.csv")"
refuse "diagram.yaml=packages: {p: $here}
$(cloud 'package://p/private.csv')"
refuse "diagram.yaml=$(cloud "package://lwr4/../../../../../../../../../../../../..$here/private.csv")"
refuse "diagram.yaml=include: [$here/private.yaml]
$(cloud "$here/private.csv")"
refuse "diagram.yaml=models: {m: {urdf: arm.urdf}}
systems: {c: {type: Constant, value: 0}}" "arm.urdf=<robot name='r'><link name='l'><collision><geometry><mesh filename='file://$here/private.csv'/></geometry></collision></link></robot>"
# What comes with it, and a package, is read.
node "$CASE/make.js" honest.mcap "diagram.yaml=models: {m: {urdf: package://planar2/planar2.urdf}}
$(cloud files/a.csv)
$short" "files/a.csv=1,2,3"
"$SIMULATOR" run honest.mcap > /dev/null
