// SPDX-License-Identifier: BSD-3-Clause
// Whether solids of two links touch: what is drawn of their collision shapes is convex, piece by piece.
import * as THREE from "three";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import type { Cube, Cylinder, Model, Pose, SceneEntity } from "./messages";
import type { LinkPose } from "./robot";

const kSteps = 64;
const kTouching = 1e-9;  // m; nearer than that to each other counts as touching

/** The farthest point in a direction, both in the solid's frame; it may change what it is given. */
type Support = (direction: THREE.Vector3) => THREE.Vector3;
interface Solid { pose: THREE.Matrix4; turn: THREE.Quaternion; support: Support; centre: THREE.Vector3; radius: number }

const sign = (x: number): number => (x < 0 ? -1 : 1);

function box({ size }: Cube): Support {
  return (d) => d.set((sign(d.x) * size.x) / 2, (sign(d.y) * size.y) / 2, (sign(d.z) * size.z) / 2);
}

function scaledSphere({ size }: Cube): Support {
  const [a, b, c] = [size.x / 2, size.y / 2, size.z / 2];
  return (d) => {
    const norm = Math.hypot(a * d.x, b * d.y, c * d.z) || 1;
    return d.set((a * a * d.x) / norm, (b * b * d.y) / norm, (c * c * d.z) / norm);
  };
}

/** Also a cone, by the scales of its ends. */
function cylinder({ size, bottom_scale = 1, top_scale = 1 }: Cylinder): Support {
  const half = size.z / 2, radius = size.x / 2;
  return (d) => {
    const across = Math.hypot(d.x, d.y), up = d.z * half + across * radius * top_scale > -d.z * half + across * radius * bottom_scale;
    const reach = across > 0 ? (radius * (up ? top_scale : bottom_scale)) / across : 0;
    return d.set(d.x * reach, d.y * reach, up ? half : -half);
  };
}

function hull(corners: THREE.Vector3[]): Support {
  return (d) => {
    let best = corners[0]!, most = -Infinity;
    for (const corner of corners) {
      const far = corner.dot(d);
      if (far > most) [best, most] = [corner, far];
    }
    return d.copy(best);
  };
}

function cornersOf(model: Model): THREE.Vector3[] {
  const bytes = Uint8Array.from(atob(model.data ?? ""), (c) => c.charCodeAt(0));
  const at = new STLLoader().parse(bytes.buffer).getAttribute("position");
  const corners = new Map<string, THREE.Vector3>();
  for (let i = 0; i < at.count; ++i) {
    const corner = new THREE.Vector3().fromBufferAttribute(at, i);
    corners.set(corner.toArray().join(), corner);
  }
  return [...corners.values()];
}

function solid(pose: Pose, support: Support, radius: number, centre = new THREE.Vector3()): Solid {
  const { position: p, orientation: q } = pose, turn = new THREE.Quaternion(q.x, q.y, q.z, q.w).normalize();
  const placed = new THREE.Matrix4().compose(new THREE.Vector3(p.x, p.y, p.z), turn, new THREE.Vector3(1, 1, 1));
  return { pose: placed, turn, support, centre: centre.applyMatrix4(placed), radius };
}

function solidsOf(entity: SceneEntity): Solid[] {
  const reach = ({ size }: Cube): number => Math.hypot(size.x, size.y, size.z) / 2;
  return [
    ...(entity.cubes ?? []).map((one) => solid(one.pose, box(one), reach(one))),
    ...(entity.spheres ?? []).map((one) => solid(one.pose, scaledSphere(one), Math.max(one.size.x, one.size.y, one.size.z) / 2)),
    ...(entity.cylinders ?? []).map((one) => solid(one.pose, cylinder(one), Math.hypot(one.size.x, one.size.z) / 2)),
    ...(entity.models ?? []).map((one) => {
      const corners = cornersOf(one), { center, radius } = new THREE.Box3().setFromPoints(corners).getBoundingSphere(new THREE.Sphere());
      return solid(one.pose, hull(corners), radius, center);
    }),
  ];
}

/** The point of the convex hull of up to four points that is nearest to the origin, and the points that carry it. */
function nearest(points: THREE.Vector3[]): { at: THREE.Vector3; of: THREE.Vector3[] } {
  const shares = sharesOf(points);
  if (shares?.every((share) => share >= 0)) {
    const at = new THREE.Vector3();
    points.forEach((point, i) => at.addScaledVector(point, shares[i]!));
    return { at, of: points };
  }
  return points.map((left) => nearest(points.filter((point) => point !== left)))
    .reduce((best, one) => (one.at.lengthSq() < best.at.lengthSq() ? one : best));
}

/** The shares, of sum 1, that bring a sum of points as near to the origin as it gets; undefined if the points lie in a
    lesser space. They solve the normal equations of the edges from the first point, by elimination. */
function sharesOf([first, ...others]: THREE.Vector3[]): number[] | undefined {
  const edges = others.map((point) => point.clone().sub(first!));
  const rows = edges.map((a) => [...edges.map((b) => a.dot(b)), -a.dot(first!)]);
  for (let k = 0; k < rows.length; ++k) {
    const pivot = rows[k]!;
    if (!(pivot[k]! > 1e-14 * edges[k]!.lengthSq())) return undefined;
    rows.forEach((row, i) => {
      if (i === k) return;
      const factor = row[k]! / pivot[k]!;
      for (let j = k; j < row.length; ++j) row[j]! -= factor * pivot[j]!;
    });
  }
  const shares = rows.map((row, k) => row.at(-1)! / row[k]!);
  return [1 - shares.reduce((sum, share) => sum + share, 0), ...shares];
}

function farthest(one: Solid, link: LinkPose, direction: THREE.Vector3): THREE.Vector3 {
  const turn = link.q.clone().multiply(one.turn).conjugate();
  return one.support(direction.clone().applyQuaternion(turn)).applyMatrix4(one.pose).applyQuaternion(link.q).add(link.p);
}

/** Whether two convex solids touch: the origin lies in their difference.
    Source: Gilbert, Johnson, Keerthi 1988; it ends at the first plane that separates them. */
function touch(a: Solid, at: LinkPose, b: Solid, bt: LinkPose): boolean {
  const between = a.centre.clone().applyQuaternion(at.q).add(at.p).sub(b.centre.clone().applyQuaternion(bt.q).add(bt.p));
  if (between.length() > a.radius + b.radius) return false;
  if (between.lengthSq() === 0) between.set(1, 0, 0);
  let simplex: THREE.Vector3[] = [], v = between;
  for (let step = 0; step < kSteps; ++step) {
    const back = v.clone().normalize();
    const w = farthest(a, at, back.clone().negate()).sub(farthest(b, bt, back));
    if (w.dot(back) > kTouching) return false;
    if (simplex.some((point) => point.distanceToSquared(w) === 0)) return false;  // no farther: apart by rounding
    const found = nearest([...simplex, w]);
    if (found.of.length === 4 || found.at.length() <= kTouching) return true;
    [simplex, v] = [found.of, found.at];
  }
  return false;
}

/** The collision shapes of a robot's links, ready to be asked. */
export class Contacts {
  private readonly solids: Solid[][];

  /** `entities` are those of the links by number, undefined for a link without shapes; `pairs` the links to look at. */
  constructor(entities: (SceneEntity | undefined)[], private readonly pairs: readonly [number, number][]) {
    this.solids = entities.map((entity) => (entity ? solidsOf(entity) : []));
  }

  at(poses: readonly LinkPose[]): [number, number][] {
    return this.pairs.filter(([a, b]) => this.solids[a]!.some((one) =>
      this.solids[b]!.some((other) => touch(one, poses[a]!, other, poses[b]!))));
  }
}
