// SPDX-License-Identifier: BSD-3-Clause
// The message on /robot (docs/reference/record_format.md), and where its links are. Lengths in m, angles in rad.
import * as THREE from "three";

export interface Placed { xyz: [number, number, number]; quaternion: [number, number, number, number] }
export interface RobotLink {
  name: string; frame: string; mass: number; visuals: string[]; collisions: string[];
}
/** Stands at multiplier * value of the position + offset; position null: fixed. Limits null: none. */
export interface RobotJoint {
  name: string; type: "fixed" | "revolute" | "continuous" | "prismatic"; parent: number; child: number;
  origin: Placed; axis: [number, number, number];
  position: number | null; multiplier: number; offset: number; mimics: string | null;
  lower: number | null; upper: number | null; velocity: number | null; effort: number | null; acceleration: number | null;
}
/** What a slider moves: limits are those of the joint and of what mimics it, `range` is as far as the slider goes. */
export interface RobotPosition {
  joint: string; unit: string; start: number; lower: number | null; upper: number | null; range: [number, number];
}
export interface RobotWarning { text: string; links: number[] }
export interface Robot {
  name: string; file: string; srdf: string | null; base: Placed;
  links: RobotLink[]; joints: RobotJoint[]; positions: RobotPosition[];
  own_pairs: [number, number][]; disabled_pairs: number; warnings: RobotWarning[];
}

export interface LinkPose { p: THREE.Vector3; q: THREE.Quaternion }

const placed = ({ xyz, quaternion }: Placed): LinkPose =>
  ({ p: new THREE.Vector3(...xyz), q: new THREE.Quaternion(...quaternion) });

export function jointValue(joint: RobotJoint, values: readonly number[]): number {
  return joint.position === null ? joint.offset : joint.multiplier * values[joint.position]! + joint.offset;
}

/** Forward kinematics: the pose of every link in the world. Joint j leads to link j + 1, parents come first. */
export function linkPoses(robot: Robot, values: readonly number[]): LinkPose[] {
  const poses = [placed(robot.base)];
  for (const joint of robot.joints) {
    const parent = poses[joint.parent]!, { p, q } = placed(joint.origin);
    p.applyQuaternion(parent.q).add(parent.p);
    q.premultiply(parent.q);
    const axis = new THREE.Vector3(...joint.axis), value = jointValue(joint, values);
    if (joint.type === "prismatic") p.add(axis.multiplyScalar(value).applyQuaternion(q));
    else if (joint.type !== "fixed") q.multiply(new THREE.Quaternion().setFromAxisAngle(axis, value));
    poses[joint.child] = { p, q: q.normalize() };
  }
  return poses;
}
