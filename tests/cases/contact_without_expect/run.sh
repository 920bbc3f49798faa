# A run into a box does not end with status 0, unless its file means it.
cp "$CASE"/arm.urdf "$CASE"/arm.yaml .
ln -s "$OCA_SOURCE" source
status() { local s=0; "$@" > out 2> err || s=$?; echo "$s"; }
has() { grep -q -e "$1" "$2" || { echo "no '$1' in:"; cat "$2"; exit 1; }; }

[ "$(status "$SIMULATOR" run arm.yaml --record a.mcap)" = 3 ]
has 'CONTACT' out
has 'NOT MET min_distance > 0' out
[ "$(status "$SIMULATOR" run a.mcap)" = 3 ]
[ "$(status "$SIMULATOR" run arm.yaml --json)" = 3 ]
has '"name": "min_distance"' out
[ "$(status "$SIMULATOR" sweep arm.yaml --samples 1 --seed 1 -o swept)" = 3 ]
[ "$(status "$SIMULATOR" run arm.yaml -s parameters.avoid=true)" = 0 ]
for meant in 'min_distance: {at_least: -0.2}' 'contact_time: {at_least: 0.1}'; do
  sed "s|^simulator:|expect: {$meant}\n&|" arm.yaml > meant.yaml
  [ "$(status "$SIMULATOR" run meant.yaml)" = 0 ]
done
sed 's|^simulator:|expect: {final_error: {at_most: 1}}\n&|' arm.yaml > other.yaml
[ "$(status "$SIMULATOR" run other.yaml)" = 3 ]
