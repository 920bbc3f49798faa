# No output may be what is run, what that reads, or another output, by whatever name.
cp "$OCA_SOURCE/diagrams/verification/lag_step.yaml" part.yaml
printf 'include: [part.yaml]\nrecord: {signals: {"lag.out": 100}}\n' > mine.yaml
printf '0,0\n1,1\n' > points.csv
cat > table.yaml <<'X'
systems: {spline: {type: SplineGenerator, file: spline.position.csv}}
record: {signals: {"spline.position": 10}}
X
cp points.csv spline.position.csv
ln mine.yaml hard.yaml
ln -s mine.yaml soft.yaml
mkdir sub
"$SIMULATOR" run mine.yaml --record run.mcap > /dev/null
md5sum *.yaml *.csv run.mcap > before
refuse() {
  status=0
  "$SIMULATOR" "$@" > out 2> err || status=$?
  [ $status = 2 ] && grep -q "^[-a-z]*: .* is .*; expected another file to write" err && md5sum --quiet -c before && return
  echo "$*: status $status"; cat err; exit 1
}
for name in mine.yaml ./mine.yaml sub/../mine.yaml hard.yaml soft.yaml part.yaml; do
  refuse run mine.yaml --record $name
  refuse run mine.yaml --report $name
done
refuse run soft.yaml --record mine.yaml
refuse run mine.yaml --record x.mcap --report sub/../x.mcap
refuse run table.yaml --csv .
refuse run mine.yaml --live=0 --record mine.yaml
refuse run run.mcap --record run.mcap
cp run.mcap lag.out.csv; md5sum lag.out.csv >> before
refuse export lag.out.csv --csv .
cp run.mcap run.svg; md5sum run.svg >> before
refuse plot run.svg --signal '*' -o run.svg
cp "$OCA_SOURCE/models/robots/planar2/planar2.urdf" arm.urdf; md5sum arm.urdf >> before
refuse robot check-collisions arm.urdf --write-srdf ./arm.urdf --samples 10
mkdir results
cp mine.yaml results/results.db
ln -s ../part.yaml results/part.yaml
md5sum results/results.db >> before
refuse sweep results/results.db --samples 1 -o results
echo 'include: [results/results.db]' > top.yaml
md5sum top.yaml >> before
refuse sweep top.yaml --samples 1 -o results
[ ! -e x.mcap ] || { echo 'a record was begun'; exit 1; }
"$SIMULATOR" run mine.yaml --record /dev/null > /dev/null
# An SRDF is written where a link leads, and over no file that merely has a similar name.
mkdir srdf && cd srdf
cp "$OCA_SOURCE/models/robots/planar2/planar2.urdf" .
echo mine > s.srdf.part
ln -s real.srdf s.srdf
"$SIMULATOR" robot check-collisions planar2.urdf --samples 10 --write-srdf s.srdf > out 2>&1 || { cat out; exit 1; }
[ "$(cat s.srdf.part)" = mine ] && [ -L s.srdf ] && grep -q '<robot' real.srdf && [ "$(ls | wc -l)" = 5 ] || { ls -l; exit 1; }
# The database of a campaign replaces a database, no other file.
"$SIMULATOR" sweep "$OCA_SOURCE/diagrams/scenarios/random_static.yaml" --samples 2 -o campaign > /dev/null 2>&1
echo mine > notes.yaml
status=0
"$SIMULATOR" merge campaign -o notes.yaml > out 2>&1 || status=$?
[ $status = 2 ] && grep -q 'no database' out && [ "$(cat notes.yaml)" = mine ] || { cat out; exit 1; }
for again in 1 2; do "$SIMULATOR" merge campaign -o all.db > out 2>&1 || { cat out; exit 1; }; done
