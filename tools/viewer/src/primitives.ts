// SPDX-License-Identifier: BSD-3-Clause
// From the entities of foxglove.SceneUpdate to three.js objects.
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { Arrow, Color, Cube, Lines, Model, Pose, SceneEntity, Vector3 } from "./messages";

// Shared by all entities; never disposed.
const kCube = new THREE.BoxGeometry(1, 1, 1);
const kSphere = new THREE.SphereGeometry(0.5, 32, 20);
const kCone = new THREE.ConeGeometry(0.5, 1, 24).rotateZ(-Math.PI / 2).translate(0.5, 0, 0);  // along x, from its foot
const kShaft = new THREE.CylinderGeometry(0.5, 0.5, 1, 16).rotateZ(-Math.PI / 2).translate(0.5, 0, 0);
const cylinders = new Map<string, THREE.BufferGeometry>();
const materials = new Map<string, THREE.MeshStandardMaterial>();
const kLineStrip = 0, kLineLoop = 1;
const kCoarseSphere = new THREE.IcosahedronGeometry(0.5, 1);  // for clouds of them
const kMany = 32;  // from so many on they are drawn together

export function applyPose(object: THREE.Object3D, pose: Pose | undefined): void {
  if (!pose) return;
  object.position.set(pose.position.x, pose.position.y, pose.position.z);
  object.quaternion.set(pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w);
}

function material(color: Color | undefined): THREE.MeshStandardMaterial {
  const { r, g, b, a } = color ?? { r: 0.7, g: 0.7, b: 0.7, a: 1 };
  const key = `${r},${g},${b},${a}`;
  let made = materials.get(key);
  if (!made) {
    made = new THREE.MeshStandardMaterial({ color: new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace),
                                            roughness: 0.55, metalness: 0.05, transparent: a < 1, opacity: a });
    materials.set(key, made);
  }
  return made;
}

/** Foxglove's cylinder: along z, with a bounding box and scales of its two ends. */
function cylinder(bottom: number, top: number): THREE.BufferGeometry {
  const key = `${bottom},${top}`;
  let made = cylinders.get(key);
  if (!made) {
    made = new THREE.CylinderGeometry(top / 2, bottom / 2, 1, 40).rotateX(Math.PI / 2);
    cylinders.set(key, made);
  }
  return made;
}

function mesh(geometry: THREE.BufferGeometry, color: Color | undefined, pose: Pose, size: Vector3): THREE.Mesh {
  const made = new THREE.Mesh(geometry, material(color));
  applyPose(made, pose);
  made.scale.set(size.x, size.y, size.z);
  made.castShadow = made.receiveShadow = true;
  return made;
}

/** Equal bodies, as the points of a cloud or the cells of a map: one draw call a colour. */
function meshes(geometry: THREE.BufferGeometry, many: Cube[]): THREE.Object3D[] {
  const byMaterial = new Map<THREE.Material, Cube[]>();
  for (const one of many) {
    const key = material(one.color);
    const same = byMaterial.get(key);
    if (same) same.push(one); else byMaterial.set(key, [one]);
  }
  const at = new THREE.Object3D();
  return [...byMaterial].map(([look, same]) => {
    const made = new THREE.InstancedMesh(geometry, look, same.length);
    same.forEach((one, i) => {
      applyPose(at, one.pose);
      at.scale.set(one.size.x, one.size.y, one.size.z);
      at.updateMatrix();
      made.setMatrixAt(i, at.matrix);
    });
    made.castShadow = made.receiveShadow = true;
    return made;
  });
}

function bodies(fine: THREE.BufferGeometry, coarse: THREE.BufferGeometry, list: Cube[]): THREE.Object3D[] {
  return list.length < kMany ? list.map((one) => mesh(fine, one.color, one.pose, one.size)) : meshes(coarse, list);
}

/** An arrow along its own x; a torque has two heads, one behind the other. */
export function arrow(message: Arrow, twoHeads: boolean): THREE.Object3D {
  const group = new THREE.Group();
  applyPose(group, message.pose);
  const shaft = new THREE.Mesh(kShaft, material(message.color));
  shaft.scale.set(message.shaft_length, message.shaft_diameter, message.shaft_diameter);
  group.add(shaft);
  for (let head = 0; head < (twoHeads ? 2 : 1); ++head) {
    const cone = new THREE.Mesh(kCone, material(message.color));
    cone.position.x = message.shaft_length - head * message.head_length * 0.9;
    cone.scale.set(message.head_length, message.head_diameter, message.head_diameter);
    group.add(cone);
  }
  return group;
}

function model(message: Model): THREE.Object3D {
  const group = new THREE.Group();
  applyPose(group, message.pose);
  group.scale.set(message.scale.x, message.scale.y, message.scale.z);
  const bytes = Uint8Array.from(atob(message.data ?? ""), (c) => c.charCodeAt(0));
  if (/stl/.test(message.media_type)) {
    const made = new THREE.Mesh(new STLLoader().parse(bytes.buffer), material(message.color));
    made.castShadow = made.receiveShadow = true;
    group.add(made);
  } else {
    new GLTFLoader().parse(bytes.buffer, "", (loaded) => {
      loaded.scene.rotation.x = Math.PI / 2;  // glTF's up is y
      group.add(loaded.scene);
    }, (error) => console.warn("mesh", error));
  }
  return group;
}

/** The pieces of lines as pairs of points. */
export function segments(lines: Lines): Vector3[] {
  const points = lines.indices?.length ? lines.indices.map((i) => lines.points[i]!) : lines.points;
  if (lines.type !== kLineStrip && lines.type !== kLineLoop) return points;
  const pairs = points.slice(1).flatMap((point, i) => [points[i]!, point]);
  if (lines.type === kLineLoop && points.length > 2) pairs.push(points.at(-1)!, points[0]!);
  return pairs;
}

export function fatLines(flat: number[], lineMaterial: LineMaterial, colors?: number[]): LineSegments2 {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(flat);
  if (colors) geometry.setColors(colors);
  const made = new LineSegments2(geometry, lineMaterial);
  if (lineMaterial.dashed) made.computeLineDistances();
  return made;
}

/** Everything of an entity but its arrows and lines, which change with every frame. */
export function solid(entity: SceneEntity): THREE.Group {
  const group = new THREE.Group();
  group.name = entity.id;
  for (const made of bodies(kCube, kCube, entity.cubes ?? [])) group.add(made);
  for (const made of bodies(kSphere, kCoarseSphere, entity.spheres ?? [])) group.add(made);
  for (const one of entity.cylinders ?? []) {
    group.add(mesh(cylinder(one.bottom_scale ?? 1, one.top_scale ?? 1), one.color, one.pose, one.size));
  }
  for (const one of entity.models ?? []) group.add(model(one));
  return group;
}

const kOverlay = { roughness: 0.8, transparent: true, opacity: 0.32, depthWrite: false,
                   polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 };
const overlay = new THREE.MeshStandardMaterial({ ...kOverlay, color: 0xf08a1d });

/** An entity that is seen through, over what else is drawn at the same place. */
export function overlaid(entity: SceneEntity): THREE.Group {
  const group = solid(entity);
  group.traverse((object) => {
    if (!(object instanceof THREE.Mesh)) return;
    object.material = overlay;
    object.castShadow = object.receiveShadow = false;
    object.renderOrder = 1;
  });
  return group;
}

const painted = new Map<string, THREE.MeshStandardMaterial>();

/** Everything of an object in a colour of the style sheet; undefined: as it was. What is seen through stays so. */
export function repaint(group: THREE.Object3D, colour: string | undefined): void {
  group.traverse((object) => {
    if (!(object instanceof THREE.Mesh)) return;
    const own = (object.userData["own"] ??= object.material) as THREE.MeshStandardMaterial;
    const key = `${colour},${own === overlay}`;
    if (colour && !painted.has(key)) {
      painted.set(key, new THREE.MeshStandardMaterial({ ...(own === overlay ? { ...kOverlay, opacity: 0.55 } : { roughness: 0.55 }), color: colour }));
    }
    object.material = colour ? painted.get(key)! : own;
  });
}
