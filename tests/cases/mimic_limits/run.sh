# A mimic's limits bind the joint that leads it, through a chain too: 'first' may use [-0.5, 0.2] rad
# and 0.5 rad/s. They were dropped in silence.
for i in $(seq 0 100); do echo "{\"request\": [$i], \"measured_position\": [0]}"; done > up
sed 's/\[\([1-9]\)/[-\1/' up > down
for way in up down; do
  "$SIMULATOR" eval MotionLimiter --params '{"period": 0.01}' --model arm="$CASE/arm.urdf" \
    < $way > out 2> err
  grep -q "joint 'first': .* 'third', bind it to \[-0.5, 0.2\] rad, 0.5 rad/s" err || { cat err; exit 1; }
  tail -1 out
  node -e '
    const lines = require("fs").readFileSync("out", "utf8").trim().split("\n").map(JSON.parse);
    const goal = process.argv[1] === "up" ? 0.2 : -0.5;
    const end = lines[lines.length - 1].position[0];
    const fastest = Math.max(...lines.map((line) => Math.abs(line.velocity[0])));
    process.exit(Math.abs(end - goal) < 1e-9 && Math.abs(fastest - 0.5) < 1e-9 ? 0 : 1);' $way
done
# A range that no position of the leader reaches is refused, naming both.
sed 's/lower="-0.8" upper="2"/lower="13" upper="14"/' "$CASE/arm.urdf" > none.urdf
! "$SIMULATOR" robot check-collisions none.urdf > out 2> err
grep "joint 'third': mimic; .* 'first'" err
