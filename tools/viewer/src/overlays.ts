// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { placeLabel } from "./labels";
import type { Color, SceneEntity, SceneUpdate, Vector3 } from "./messages";
import { element, type Page } from "./page";
import { arrow, fatLines, segments } from "./primitives";

export type Layer = "distances" | "forces" | "torques" | "requested" | "actual" | "labels";

/** What is drawn over the solids: distances, forces, torques, trails; each can be switched off. */
export class Overlays {
  readonly group = new THREE.Group();
  /** m; nearer lines are solid and thick, farther ones thin and dashed */
  limit = 0.3;
  private readonly layers = new Map<Layer, THREE.Group>();
  private readonly on = new Map<Layer, boolean>();
  private readonly near = new LineMaterial({ vertexColors: true, linewidth: 3.5 });
  private readonly far = new LineMaterial({ vertexColors: true, linewidth: 1.3, dashed: true, dashSize: 0.025, gapSize: 0.02 });
  private readonly requested = new LineMaterial({ linewidth: 2, dashed: true, dashSize: 0.03, gapSize: 0.018 });
  private readonly actual = new LineMaterial({ linewidth: 2.6 });
  private readonly nearest: HTMLElement;
  private nearestAt: THREE.Vector3 | undefined;
  private pieces: SceneEntity[] = [];

  constructor(private readonly page: Page, private readonly labels: HTMLElement) {
    for (const layer of ["distances", "forces", "torques", "requested", "actual"] as const) {
      const made = new THREE.Group();
      this.layers.set(layer, made);
      this.on.set(layer, true);
      this.group.add(made);
    }
    this.on.set("labels", true);
    this.nearest = element("span", "label nearest");
    this.nearest.hidden = true;
    labels.append(this.nearest);
  }

  isOn(layer: Layer): boolean { return this.on.get(layer) ?? true; }
  turn(layer: Layer, on: boolean): void {
    this.on.set(layer, on);
    const group = this.layers.get(layer);
    if (group) group.visible = on;
    this.labels.classList.toggle("off", !this.isOn("labels"));
  }

  showForces(update: SceneUpdate): void {
    for (const layer of ["distances", "forces", "torques"] as const) {
      const group = this.layers.get(layer)!;
      clear(group);
      for (const entity of update.entities ?? []) {
        if (entity.id !== layer) continue;
        for (const one of entity.arrows ?? []) group.add(arrow(one, layer === "torques"));
      }
    }
    this.showDistances((update.entities ?? []).filter((entity) => entity.id === "distances"));
  }

  private showDistances(entities: SceneEntity[]): void {
    const near = { flat: [] as number[], colors: [] as number[] }, far = { flat: [] as number[], colors: [] as number[] };
    let least = Infinity;
    this.nearestAt = undefined;
    for (const { a, b, colours, distance } of entities.flatMap(distanceLines)) {
      const into = (distance ?? Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z)) < this.limit ? near : far;
      into.flat.push(a.x, a.y, a.z, b.x, b.y, b.z);
      for (const colour of colours) push(into.colors, colour);
      if (distance !== undefined && distance < least) {
        least = distance;
        this.nearestAt = middle(a, b);
      }
    }
    const group = this.layers.get("distances")!;
    if (near.flat.length > 0) group.add(fatLines(near.flat, this.near, near.colors));
    if (far.flat.length > 0) group.add(fatLines(far.flat, this.far, far.colors));
    if (this.nearestAt) {
      this.nearest.textContent = `${least.toFixed(3)} m`;
      this.nearest.classList.toggle("close", least < this.limit);
      this.nearest.classList.toggle("contact", least <= 0);
    }
  }

  showTrails(pieces: SceneEntity[], _time: number): void {
    if (pieces.length === this.pieces.length && pieces.every((piece, i) => piece === this.pieces[i])) return;
    this.pieces = pieces;
    for (const layer of ["requested", "actual"] as const) {
      const group = this.layers.get(layer)!;
      clear(group);
      const flat = pieces.filter((piece) => piece.id.includes(`/${layer}/`))
        .flatMap((piece) => piece.lines ?? []).flatMap(segments).flatMap((p) => [p.x, p.y, p.z]);
      if (flat.length > 0) group.add(fatLines(flat, layer === "requested" ? this.requested : this.actual));
    }
  }

  placeLabels(camera: THREE.Camera, canvas: HTMLCanvasElement): void {
    this.nearest.hidden = !this.nearestAt || !this.isOn("distances");
    if (this.nearestAt && !this.nearest.hidden) placeLabel(this.nearest, this.nearestAt, camera, canvas);
  }

  applyTheme(): void {
    this.requested.color.set(this.page.colour("--requested"));
    this.actual.color.set(this.page.colour("--actual"));
  }

  resize(width: number, height: number): void {
    for (const material of [this.near, this.far, this.requested, this.actual]) material.resolution.set(width, height);
  }
}

interface DistanceLine { a: Vector3; b: Vector3; colours: Color[]; distance: number | undefined }

/** The lines of an entity with their signed distances, if it has them: a line is as long as two
    shapes are apart, and as they are deep in each other, so its length says nothing. */
function distanceLines(entity: SceneEntity): DistanceLine[] {
  const text = entity.metadata?.find(({ key }) => key === "distances")?.value;
  let signed: unknown;
  try {
    signed = JSON.parse(text ?? "null");
  } catch { /* as if there were none */ }
  const found: DistanceLine[] = [];
  for (const lines of entity.lines ?? []) {
    const points = segments(lines);
    for (let i = 0; i + 1 < points.length; i += 2) {
      const value: unknown = Array.isArray(signed) ? signed[found.length] : undefined;
      found.push({ a: points[i]!, b: points[i + 1]!,
                   colours: [lines.colors?.[i] ?? lines.color, lines.colors?.[i + 1] ?? lines.color],
                   distance: typeof value === "number" ? value : undefined });
    }
  }
  return found;
}

function push(colors: number[], colour: Color): void {
  const linear = new THREE.Color().setRGB(colour.r, colour.g, colour.b, THREE.SRGBColorSpace);
  colors.push(linear.r, linear.g, linear.b);
}

function middle(a: Vector3, b: Vector3): THREE.Vector3 {
  return new THREE.Vector3((a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2);
}

/** Lines own their geometry; arrows share theirs. */
function clear(group: THREE.Group): void {
  for (const child of group.children) {
    if ("isLineSegments2" in child) (child as unknown as THREE.Mesh).geometry.dispose();
  }
  group.clear();
}
