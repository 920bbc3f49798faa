# A misspelt element, another robot's file and xacro that was not expanded are errors with a line.
cat > arm.urdf <<'X'
<robot name="arm"><link name="base"/><link name="upper"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="turn" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint></robot>
X
cat > d.yaml <<'X'
models: {arm: {urdf: arm.urdf, srdf: arm.srdf}}
systems: {q: {type: Constant, value: [0.5]}, k: {type: RobotKinematics}}
connections: [q.value -> k.position]
X
try() {  # ROBOT ELEMENTS WHAT; WHAT is empty if it is fine
  printf '<robot name="%s">\n%s\n</robot>\n' "$1" "$2" > arm.srdf
  status=0
  "$SIMULATOR" check d.yaml > /dev/null 2> err || status=$?
  if [ -z "$3" ]; then [ $status = 0 ] && return
  else [ $status = 2 ] && grep -q "arm.srdf:[12]: .*$3" err && return; fi
  echo "$2: status $status, expected $3"; cat err; exit 1
}
try arm '<disable_default_collisions link="upper"/><enable_collisions link1="upper" link2="base"/>' ''
try arm '<group name="g"><joint name="turn"/></group><group_state name="s" group="g"><joint name="turn" value="1"/></group_state>' ''
try arm '<enable_collision link1="upper" link2="base"/>' "nearest is 'enable_collisions'"
try arm '<disable_collisions link1="upper" link="base"/>' "unknown attribute; got 'link'"
try arm '<disable_collisions link1="uper" link2="base"/>' "nearest is 'upper'"
try arm '<passive_joint name="trun"/>' "nearest is 'turn'"
try leg '' "got 'leg'; expected 'arm'"
try arm '<xacro:pairs/>' 'run xacro first'
try arm '<disable_collisions link1="${p}upper" link2="base"/>' 'run xacro first'
