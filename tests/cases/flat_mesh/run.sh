# A sticker in one plane is a convex set like any other: it loads, and one warning says how thick it
# counts as, also where it is an obstacle or decomposed.
"$SIMULATOR" robot check-collisions "$CASE/arm.urdf" > out 2> err
[ "$(grep -c "mesh 'flat.stl' is flat; counts as .* m thick" err)" = 1 ]
[ "$(wc -l < err)" = 1 ]
cat > d.yaml <<EOF
systems:
  o:
    type: ObstacleSource
    obstacles:
      - {id: a, pose: {xyz: [0, 0, 0]}, shape: {type: mesh, file: "$CASE/flat.stl"}}
      - {id: b, pose: {xyz: [0, 0, 0]}, shape: {type: mesh, file: "$CASE/flat.stl", collision: decomposition}}
EOF
HOME=$PWD "$SIMULATOR" check d.yaml > out 2> err
[ "$(grep -c "is flat; counts as .* m thick" err)" = 1 ]
