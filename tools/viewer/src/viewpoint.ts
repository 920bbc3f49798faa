// SPDX-License-Identifier: BSD-3-Clause
// From where a scene is looked at first.
import * as THREE from "three";

/** Bodies of one name are one: what hides a part of it is itself. */
export interface Body { name: string; object: THREE.Object3D }

// From above, else from below: a ceiling hides what hangs from it.
const kDirections = [new THREE.Vector3(0.78, -0.5, 0.38).normalize(), new THREE.Vector3(0.78, -0.5, -0.2).normalize()];

/** The share of `bodies` whose middle nothing else hides from a point. */
function shareSeen(from: THREE.Vector3, bodies: Body[], all: Body[], camera: THREE.Camera): number {
  const caster = new THREE.Raycaster(), objects = all.map(({ object }) => object);
  caster.camera = camera;
  const nameOf = (hit: THREE.Object3D): string | undefined => {
    let at: THREE.Object3D | null = hit;
    while (at && !objects.includes(at)) at = at.parent;
    return all.find(({ object }) => object === at)?.name;
  };
  const seen = bodies.filter(({ name, object }) => {
    const middle = new THREE.Box3().setFromObject(object).getCenter(new THREE.Vector3());
    caster.set(from, middle.clone().sub(from).normalize());
    caster.far = middle.distanceTo(from);
    const hit = caster.intersectObjects(objects, true)[0];
    return !hit || nameOf(hit.object) === name;
  });
  return seen.length / Math.max(1, bodies.length);
}

/** From a centre to the camera, which is `distance` away: from above, unless most of the bodies are hidden there and not below. */
export function directionTo(centre: THREE.Vector3, distance: number, bodies: Body[], all: Body[], camera: THREE.Camera): THREE.Vector3 {
  const [above, below] = kDirections as [THREE.Vector3, THREE.Vector3];
  const share = (direction: THREE.Vector3): number => shareSeen(centre.clone().addScaledVector(direction, distance), bodies, all, camera);
  const high = share(above);
  return high < 0.5 && share(below) > 2 * high ? below : above;
}
