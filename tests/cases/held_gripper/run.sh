# A gripper that holds something at 0.02 m was closed to evade. Held, by its joint or by the group of
# the SRDF that is not the arm, it is no joint of the robot: all methods evade with the other two.
diagram() { # MODEL
  sed "s#@OCA@#$OCA_SOURCE#; s#@MODEL@#$1#" > arm.yaml << 'END'
name: gripper
include: ["@OCA@/diagrams/parts/avoidance.yaml"]
parameters: {avoidance: safety_filter}
simulator: {duration: 8}
models:
  arm: {urdf: arm.urdf, srdf: arm.srdf, @MODEL@}
systems:
  obstacles:
    type: ObstacleSource
    obstacles:
      - {id: box, shape: {type: box, size: [0.1, 0.1, 0.1]}, pose: {xyz: [0, 1.02, 0.35]}}
  spline:
    type: SplineGenerator
    period: ${1 / rate}
    key_points:
      - {time: 0.5, position: out}
      - {time: 5.5, position: {j1: 2.5}}
  plant: {initial_position: out}
record: {signals: {"plant.position": 50}}
END
}
cp "$CASE/arm.urdf" "$CASE/arm.srdf" .
for model in "held: {left_joint: 0.02}" "group: arm, held: {gripper: grasped}"; do
  diagram "$model"
  for method in report_limited safety_filter recommended; do
    "$SIMULATOR" run arm.yaml -s parameters.avoidance=$method --csv csv --record out.mcap > out 2> err ||
      { cat err; exit 1; }
    grep -q "clearance *clear: " out || { cat out; exit 1; }
    head -1 csv/plant.position.csv
    [ "$(head -1 csv/plant.position.csv | tr -cd , | wc -c)" = 2 ]   # time and two joints
  done
  "$SIMULATOR" run out.mcap > again 2> err || { cat err; exit 1; }
  diff <(grep clearance out) <(grep clearance again)
done
# The hand stays where it is held in every picture: a link 0.02 m aside of the arm's end.
! "$SIMULATOR" run arm.yaml -s 'models.arm.held={left_joint: 0.05}' > out 2> err
grep "held.left_joint: got 0.05 m; expected 0 to 0.04" err
