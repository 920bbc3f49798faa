# The pebble must take nothing from what the filter does about the box, and be told by name.
ln -s "$OCA_SOURCE/diagrams/parts" parts
cp "$CASE"/arm.* .
"$SIMULATOR" run arm.yaml --no-progress --csv out | tee summary
grep -q 'clear: nearest' summary
grep -q '"kind":"unmovable","link":"turret","obstacle":"pebble"' out/filter.activity.jsonl
