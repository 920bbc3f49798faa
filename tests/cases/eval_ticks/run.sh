# SPDX-License-Identifier: BSD-3-Clause
# `eval` serves one period a line, however many came before: no sample is lost, no update doubled.
for i in {0..99}; do echo "{\"in\": [$i]}"; done | "$SIMULATOR" eval ZeroOrderHold --params '{"period": 0.1}' > held
for i in {0..99}; do echo "{\"out\":[$i]}"; done > expected
diff expected held

for i in {1..50}; do echo '{"delta": [9]}'; done |
  "$SIMULATOR" eval DeltaLimiter --params '{"max_joint_velocity": 0.6, "period": 0.01}' |
  sed 's/.*\[\(.*\)\].*/\1/' |
  awk '{ off = $1 - 0.006 * NR; if (off * off > 1e-18) { print "line " NR ": " $1; bad = 1 } }
       END { exit bad || NR != 50 }'

# The ticks as times.
for t in 0 0.1 0.2 0.3 0.4 0.5 0.6 0.7; do echo "{\"time\": $t, \"delta\": [9]}"; done |
  "$SIMULATOR" eval DeltaLimiter --params '{"max_joint_velocity": 1, "period": 0.1}' > timed
if grep error timed; then exit 1; fi
[ "$(wc -l < timed)" = 8 ]
