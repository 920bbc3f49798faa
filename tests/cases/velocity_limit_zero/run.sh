# Exporters write a velocity limit of 0 for "not filled in", and none for continuous joints: said
# once at load, and the same for every method: the joint moves. `recommended` ended with a NaN.
cp "$CASE"/arm.* .
ln -s "$OCA_SOURCE/diagrams/parts" parts
status=0
for method in "$OCA_SOURCE"/diagrams/parts/avoidance_*.yaml; do
  method=${method##*/avoidance_}
  method=${method%.yaml}
  "$SIMULATOR" check arm.yaml -s parameters.avoidance=$method > out 2>&1
  if ! grep -q "warning: models.arm: joint 'shoulder': velocity limit 0 .* not given" out ||
     ! grep -q "warning: models.arm: joint 'elbow': no velocity limit" out; then
    echo "$method:"; cat out; status=1
  fi
  code=0
  "$SIMULATOR" run arm.yaml --no-progress -s parameters.avoidance=$method > out 2>&1 || code=$?
  echo "$method $code $(grep -c 'goal  *reached' out)"
  # The report's field may chatter or not arrive; it moves and ends with a judgement.
  if [ $code != 0 ] && [ $code != 3 ] || grep -qi 'FAILED\|not finite\|nan' out; then
    cat out; status=1
  fi
  case $method in safety_filter|recommended) [ $code = 0 ] || { cat out; status=1; } ;; esac
done
exit $status
