# "Never in collision" is only written on evidence: not from a range that samples cannot cover. All
# else works with such a range: a filtered motion, a planned one.
ln -s "$OCA_SOURCE/diagrams/parts" parts
cp "$CASE/move.yaml" .
sed 's/WIDE/4/g' "$CASE/rail.urdf" > rail.urdf
"$SIMULATOR" robot check-collisions rail.urdf --samples 500 --write-srdf rail.srdf
! grep -i never rail.srdf
for wide in 1000 1e9 1e308; do
  sed "s/WIDE/$wide/g" "$CASE/rail.urdf" > rail.urdf
  rm -f rail.srdf
  ! "$SIMULATOR" robot check-collisions rail.urdf --samples 500 --write-srdf rail.srdf > out 2> err
  grep "robot 'rail' joint 'slide': limits" err
  [ ! -e rail.srdf ]
  for method in safety_filter recommended; do
    "$SIMULATOR" run move.yaml --no-progress -s parameters.avoidance=$method > out 2>&1 ||
      { cat out; exit 1; }
    grep "joint 'slide': range" out
    ! grep -i 'nan\|inf ' out
  done
  # A turning joint comes back after a turn, which is what is drawn from.
  sed 's/type="prismatic"/type="fixed"/' rail.urdf > turn.urdf
  "$SIMULATOR" robot check-collisions turn.urdf --samples 500 | grep 'rail .* car .* Adjacent .* 500$'
done
# A start out there is refused.
! "$SIMULATOR" run move.yaml --no-progress -s 'systems.plant.initial_position=[2e6, 0]' 2> err
grep "plant.position .*joint 'slide'; got 2e+06" err
! "$SIMULATOR" check move.yaml -s 'systems.spline.key_points.1.position=[3e7, 0]' 2> err
grep "key_points\[1\].position" err
