// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from "three";
import type { LiveSource } from "./live_source";
import type { SceneView } from "./scene_view";

const kObstacle = "obstacle/";

/** Drags obstacles of a live scene, parallel to the picture; with Shift along the vertical. */
export function dragObstacles(view: SceneView, live: LiveSource): void {
  const canvas = view.canvas;
  let held: { parameter: string; plane: THREE.Plane; offset: THREE.Vector3 } | undefined;
  const at = (event: PointerEvent): THREE.Raycaster => {
    const box = canvas.getBoundingClientRect();
    return view.ray(event.clientX - box.left, event.clientY - box.top);
  };
  canvas.addEventListener("pointerdown", (event) => {
    const box = canvas.getBoundingClientRect();
    const hit = view.frameAt(event.clientX - box.left, event.clientY - box.top);
    if (!hit?.frame.startsWith(kObstacle)) return;
    const normal = event.shiftKey ? view.camera.getWorldDirection(new THREE.Vector3()) : new THREE.Vector3(0, 0, 1);
    held = { parameter: live.positionOf(hit.frame.slice(kObstacle.length)), plane: new THREE.Plane().setFromNormalAndCoplanarPoint(normal, hit.point),
             offset: hit.origin.sub(hit.point) };
    view.controls.enabled = false;
    canvas.setPointerCapture(event.pointerId);
  }, { capture: true });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    const point = at(event).ray.intersectPlane(held.plane, new THREE.Vector3());
    if (point) live.set(held.parameter, point.add(held.offset).toArray());
  });
  const release = (): void => {
    held = undefined;
    view.controls.enabled = true;
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
}
