// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace oca::robot::test {

/// An arm in the plane with two fingers, the right one of which mimics the left one, and a wheel
/// without a motor. The tip of either finger is 0.05 m beyond the origin of its link.
inline const char* const kGripperArmUrdf = R"(<robot name="gripper_arm">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.4 0.08 0.08"/></geometry></collision></link>
  <link name="fore"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.3 0.06 0.06"/></geometry></collision></link>
  <link name="left"><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
  <link name="wheel"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="2" effort="50"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/><limit lower="0.1" upper="2.2" velocity="2" effort="50"/></joint>
  <joint name="left_slide" type="prismatic"><parent link="fore"/><child link="left"/><origin xyz="0.4 0 0" rpy="0 0 0.5"/><axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="0.2" effort="20"/></joint>
  <joint name="right_slide" type="prismatic"><parent link="fore"/><child link="right"/><origin xyz="0.4 0 0"/><axis xyz="0 -1 0"/><limit lower="0" upper="0.05" velocity="0.2" effort="20"/><mimic joint="left_slide" multiplier="0.5" offset="0.01"/></joint>
  <joint name="roll" type="continuous"><parent link="base"/><child link="wheel"/><axis xyz="0 1 0"/></joint>
</robot>
)";

inline const char* const kGripperArmSrdf = R"(<robot name="gripper_arm">
  <group name="arm"><chain base_link="base" tip_link="fore"/></group>
  <group name="hand"><joint name="left_slide"/><joint name="right_slide"/></group>
  <group name="finger"><link name="left"/></group>
  <group name="other_finger"><joint name="right_slide"/></group>
  <group name="whole"><group name="arm"/><group name="hand"/></group>
  <group name="across"><chain base_link="right" tip_link="upper"/></group>
  <group name="driven"><joint name="roll"/><joint name="shoulder"/></group>
  <group name="nothing"><link name="base"/></group>
  <group name="ring"><group name="chain"/></group>
  <group name="chain"><group name="ring"/></group>
  <group_state name="open" group="hand"><joint name="left_slide" value="0.04"/><joint name="right_slide" value="0.03"/></group_state>
  <group_state name="torn" group="hand"><joint name="left_slide" value="0.05"/></group_state>
  <group_state name="ready" group="arm"><joint name="shoulder" value="0.3"/><joint name="elbow" value="1.2"/></group_state>
  <group_state name="bent" group="arm"><joint name="elbow" value="2"/></group_state>
  <group_state name="home" group="arm"><joint name="shoulder" value="0"/></group_state>
  <group_state name="home" group="hand"><joint name="left_slide" value="0.01"/></group_state>
  <passive_joint name="roll"/>
  <disable_collisions link1="left" link2="right" reason="Default"/>
</robot>
)";

}  // namespace oca::robot::test
