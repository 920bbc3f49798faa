# Mimics that lead to a fixed joint, directly or not, or lead round are refused; that of a fixed
# joint does nothing, which is told.
robot() {  # TYPE_A MORE_A TYPE_B MORE_B
  echo '<robot name="r"><link name="l"/><link name="m"/><link name="n"/>
    <joint name="a" type="'"$1"'"><parent link="l"/><child link="m"/>'"$2"'</joint>
    <joint name="b" type="'"$3"'"><parent link="m"/><child link="n"/>'"$4"'</joint></robot>' > r.urdf
}
refused() {
  status=0
  "$SIMULATOR" robot check-collisions r.urdf > out 2> err || status=$?
  cat err
  [ $status = 2 ] && grep -q "r.urdf:[23]: joint '.': mimic" err
}
robot fixed '' continuous '<mimic joint="a"/>'
refused
robot fixed '<mimic joint="b"/>' continuous ''
"$SIMULATOR" robot check-collisions r.urdf 2>&1 | tee out
grep -q "warning: .*joint 'a': fixed, so its <mimic> of 'b' does nothing" out
robot continuous '<mimic joint="b"/>' continuous '<mimic joint="a"/>'
refused
robot continuous '<mimic joint="a"/>' continuous ''
refused
