// SPDX-License-Identifier: BSD-3-Clause
// The messages of docs/reference/record_format.md that the page reads; shapes are Foxglove's schemas.

export interface Vector3 { x: number; y: number; z: number }
export interface Quaternion extends Vector3 { w: number }
export interface Pose { position: Vector3; orientation: Quaternion }
export interface Color { r: number; g: number; b: number; a: number }

export interface FrameTransform {
  parent_frame_id: string; child_frame_id: string; translation: Vector3; rotation: Quaternion;
}
export interface FrameTransforms { transforms: FrameTransform[] }

export interface Arrow {
  pose: Pose; shaft_length: number; shaft_diameter: number; head_length: number; head_diameter: number;
  color: Color;
}
export interface Lines {
  type: number; pose: Pose; thickness: number; points: Vector3[]; color: Color; colors?: Color[];
  indices?: number[];
}
export interface Cube { pose: Pose; size: Vector3; color: Color }
export interface Cylinder extends Cube { bottom_scale?: number; top_scale?: number }
export interface Model {
  pose: Pose; scale: Vector3; color: Color; override_color?: boolean; media_type: string; data?: string;
}
export interface SceneEntity {
  id: string; frame_id: string; arrows?: Arrow[]; lines?: Lines[]; cubes?: Cube[]; spheres?: Cube[];
  cylinders?: Cylinder[]; models?: Model[]; metadata?: { key: string; value: string }[];
}
export interface SceneUpdate { deletions?: { type: number; id: string }[]; entities?: SceneEntity[] }

export interface Expectation { name: string; value: number | null; bound: string; at?: number; ok: boolean }
/** What `simulator run --json` prints; a record ends with it. */
export interface RunReport {
  name?: string; seed?: number; duration?: number; steps?: number; wall_seconds?: number;
  realtime_factor?: number; failure?: string; interrupted?: boolean;
  metrics?: Record<string, unknown>; expectations?: Expectation[];
}
