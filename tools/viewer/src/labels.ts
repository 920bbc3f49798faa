// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from "three";

/** Puts a label of the page over a point of the world. */
export function placeLabel(label: HTMLElement, point: THREE.Vector3, camera: THREE.Camera, canvas: HTMLCanvasElement,
                           down = 0): void {
  const seen = point.clone().project(camera);
  label.hidden = seen.z > 1 || Math.abs(seen.x) > 1 || Math.abs(seen.y) > 1;
  const x = ((seen.x + 1) / 2) * canvas.clientWidth, y = ((1 - seen.y) / 2) * canvas.clientHeight;
  label.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${(y + down).toFixed(1)}px)`;
}
