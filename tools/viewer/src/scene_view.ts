// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { EntityHistory } from "./history";
import { placeLabel } from "./labels";
import { Overlays } from "./overlays";
import type { FrameTransform, FrameTransforms, SceneEntity, SceneUpdate } from "./messages";
import { byId, element, type Page } from "./page";
import { overlaid, repaint, segments, solid } from "./primitives";
import type { Recording } from "./recording";
import { directionTo } from "./viewpoint";

/** px; keeps the names of obstacles clear of the nearest distance */
const kUnder = 26;

const kNoWebGL = "This browser has no WebGL, so the scene is not drawn. All else is here.";

function makeRenderer(canvas: HTMLCanvasElement): THREE.WebGLRenderer | undefined {
  const wanted = { antialias: true, preserveDrawingBuffer: true };
  const context = canvas.getContext("webgl2", wanted) as WebGL2RenderingContext | null;
  if (!context) return undefined;
  const renderer = new THREE.WebGLRenderer({ canvas, context, ...wanted });
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  renderer.toneMapping = THREE.NeutralToneMapping;
  return renderer;
}

/** What is solid: topics of entities. */
export type Solids = "/scene/robots" | "/scene/obstacles" | "/scene/collisions";

interface Shown { entity: SceneEntity; object: THREE.Object3D; topic: Solids }
interface Label { element: HTMLElement; at: THREE.Object3D; down: number }

/** The world at one instant: robots, obstacles, and what pushes them. z is up, lengths in m. */
export class SceneView {
  readonly overlays: Overlays;
  readonly camera = new THREE.PerspectiveCamera(38, 1, 0.02, 60);
  readonly controls: OrbitControls;
  readonly canvas = element("canvas");
  /** None where the browser has no WebGL: then everything but the picture is there. */
  private readonly renderer: THREE.WebGLRenderer | undefined;
  private readonly scene = new THREE.Scene();
  private readonly world = new THREE.Group();
  private readonly frames = new Map<string, THREE.Group>();
  private readonly histories = new Map<string, EntityHistory>();
  private readonly shown = new Map<string, Shown>();
  private readonly standing = new Map<string, Label>();
  private readonly hidden = new Set<Solids>();
  /** Of the picture's height, what is drawn takes 1 / room at the start. */
  room = 0.92;
  private grid = new THREE.GridHelper();
  private framed = false;
  /** Something moved since the last picture. */
  private stale = true;

  constructor(private readonly page: Page, private readonly parent: HTMLElement,
              private readonly labels: HTMLElement, private recording: Recording) {
    this.renderer = makeRenderer(this.canvas);
    parent.append(this.renderer ? this.canvas : element("p", "unseen", kNoWebGL));
    labels.hidden = byId("switches").hidden = !this.renderer;
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(2.6, -1.9, 1.9);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.target.set(0, 0.15, 0.75);
    this.controls.addEventListener("change", () => (this.stale = true));
    this.scene.add(this.world);
    this.overlays = new Overlays(page, labels);
    this.world.add(this.overlays.group);
    this.addLights();
    this.applyTheme();
    page.onTheme(() => this.applyTheme());
    new ResizeObserver(() => this.resize()).observe(parent);
    this.resize();
  }

  /** Starts over with another recording. */
  reset(recording: Recording): void {
    this.recording = recording;
    for (const id of [...this.shown.keys()]) this.remove(id);
    this.histories.clear();
    this.framed = false;
  }

  /** Puts everything where it is at `time`. */
  show(time: number): void {
    this.showTransforms(time);
    for (const name of ["/scene/robots", "/scene/obstacles", "/scene/collisions"] as const) this.showHistory(name, time);
    const trails = this.history("/scene/trails");
    const pieces: SceneEntity[] = [];
    if (trails) {
      for (const id of trails.ids) {
        const piece = trails.at(id, time);
        if (piece) pieces.push(piece);
      }
    }
    this.overlays.showTrails(pieces, time);
    const forces = this.recording.topics.get("/scene/forces");
    const index = forces ? forces.indexAt(time) : -1;
    this.overlays.showForces(index >= 0 ? (forces!.message(index) as SceneUpdate) : { entities: [] });
    if (!this.framed && this.shown.size > 0) this.frameAll();
    this.stale = true;
  }

  render(): void {
    if (this.controls.enabled) this.controls.update();
    if (!this.stale) return;
    this.stale = false;
    if (!this.renderer) return;
    this.renderer.render(this.scene, this.camera);
    this.placeLabels();
  }

  touch(): void { this.stale = true; }

  /** Where a frame is in the world, for tests. */
  positionOf(frame: string): number[] | undefined {
    const found = this.frames.get(frame);
    return found && found.getWorldPosition(new THREE.Vector3()).toArray();
  }

  /** The frame whose solids are at a point of the canvas (CSS pixels), with the point that was hit. */
  frameAt(x: number, y: number): { frame: string; point: THREE.Vector3; origin: THREE.Vector3 } | undefined {
    const seen = [...this.shown.values()].filter(({ topic }) => !this.hidden.has(topic));
    const hit = this.ray(x, y).intersectObjects(seen.map((one) => one.object), true)[0];
    for (let object: THREE.Object3D | null | undefined = hit?.object; object; object = object.parent) {
      const frame = [...this.frames].find(([, group]) => group === object)?.[0];
      if (frame) return { frame, point: hit!.point, origin: object.getWorldPosition(new THREE.Vector3()) };
    }
    return undefined;
  }

  /** Puts a frame where it is in its parent, whatever the recording says. */
  place(transform: FrameTransform): void {
    const { translation: p, rotation: q } = transform;
    const group = this.frame(transform.child_frame_id);
    const parent = transform.parent_frame_id === "world" ? this.world : this.frame(transform.parent_frame_id);
    if (group.parent !== parent) parent.add(group);
    group.position.set(p.x, p.y, p.z);
    group.quaternion.set(q.x, q.y, q.z, q.w);
    this.stale = true;
  }

  /** Shows or hides all solids of a topic. */
  turn(topic: Solids, on: boolean): void {
    if (on) this.hidden.delete(topic); else this.hidden.add(topic);
    for (const one of this.shown.values()) if (one.topic === topic) one.object.visible = on;
    this.stale = true;
  }
  isOn(topic: Solids): boolean { return !this.hidden.has(topic); }

  /** Gives the solids of a frame another colour; none: their own. */
  paint(frame: string, colour: string | undefined): void {
    for (const { entity, object } of this.shown.values()) {
      if (entity.frame_id !== frame) continue;
      repaint(object, colour);
      object.userData["paint"] = colour;
    }
    this.stale = true;
  }

  /** The colours that a frame was painted in, one a body, for tests. */
  coloursOf(frame: string): string[] {
    const bodies = [...this.shown.values()].filter(({ entity }) => entity.frame_id === frame);
    return bodies.map(({ object }) => object.userData["paint"] as string);
  }

  /** A label at the middle of what is drawn of a frame; empty text: none. */
  label(frame: string, text: string, className: string): void {
    const old = this.standing.get(frame);
    if (old?.element.textContent === text && old.element.className === `label ${className}`) return;
    old?.element.remove();
    old?.at.removeFromParent();
    this.standing.delete(frame);
    if (text !== "") this.addLabel(frame, text, className, this.middleOf(frame), 0);
    this.stale = true;
  }

  ray(x: number, y: number): THREE.Raycaster {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((x / width) * 2 - 1, 1 - (y / height) * 2), this.camera);
    return caster;
  }

  private frame(name: string): THREE.Group {
    let group = this.frames.get(name);
    if (!group) {
      this.frames.set(name, group = new THREE.Group());
      this.world.add(group);
    }
    return group;
  }

  private showTransforms(time: number): void {
    const topic = this.recording.topics.get("/tf");
    if (!topic) return;
    const index = topic.indexAt(time);
    if (index < 0) return;
    const now = topic.message(index) as FrameTransforms;
    for (const transform of now.transforms) this.place(transform);
  }

  private history(name: string): EntityHistory | undefined {
    const topic = this.recording.topics.get(name);
    if (!topic) return undefined;
    let history = this.histories.get(name);
    if (!history) this.histories.set(name, history = new EntityHistory(topic));
    history.follow();
    return history;
  }

  private showHistory(name: Solids, time: number): void {
    const history = this.history(name);
    if (!history) return;
    for (const id of history.ids) {
      const entity = history.at(id, time), old = this.shown.get(id);
      if (old && old.entity === entity) continue;
      if (old) this.remove(id);
      if (!entity) continue;
      const object = name === "/scene/collisions" ? overlaid(entity) : solid(entity);
      object.visible = this.isOn(name);
      (entity.frame_id === "world" ? this.world : this.frame(entity.frame_id)).add(object);
      this.shown.set(id, { entity, object, topic: name });
      if (name === "/scene/obstacles") this.addLabel(id, id.replace(/^obstacle\//, ""), "obstacle", object, kUnder);
    }
  }

  private addLabel(id: string, text: string, className: string, at: THREE.Object3D, down: number): void {
    const made = element("span", `label ${className}`, text);
    this.labels.append(made);
    this.standing.set(id, { element: made, at, down });
  }

  /** A point of a frame amid its solids; its origin if it has none. */
  private middleOf(name: string): THREE.Object3D {
    const frame = this.frame(name), box = new THREE.Box3(), middle = new THREE.Object3D();
    this.world.updateMatrixWorld(true);
    for (const { entity, object } of this.shown.values()) if (entity.frame_id === name) box.expandByObject(object);
    if (!box.isEmpty()) middle.position.copy(frame.worldToLocal(box.getCenter(new THREE.Vector3())));
    frame.add(middle);
    return middle;
  }

  private remove(id: string): void {
    this.shown.get(id)?.object.removeFromParent();
    this.shown.delete(id);
    this.standing.get(id)?.element.remove();
    this.standing.delete(id);
  }

  private placeLabels(): void {
    for (const { element: label, at, down } of this.standing.values()) {
      placeLabel(label, at.getWorldPosition(new THREE.Vector3()), this.camera, this.canvas, down);
    }
    this.overlays.placeLabels(this.camera, this.canvas);
  }

  /** Turns the camera to all there is, robots and obstacles, once. */
  private frameAll(): void {
    this.world.updateMatrixWorld(true);
    const box = new THREE.Box3();
    const moving = this.movingFrames();
    const all = [...this.shown].map(([id, { entity: { frame_id: frame }, object }]) => ({ frame, name: frame === "world" ? id : frame, object }));
    const chosen = all.filter(({ frame }) => moving.has(frame) || frame.startsWith("obstacle/"));
    const bodies = chosen.length > 0 ? chosen : all;
    for (const { object } of bodies) box.expandByObject(object);
    const trails = this.recording.topics.get("/scene/trails");
    if (trails && trails.length > 0) {
      for (const entity of (trails.message(trails.length - 1) as SceneUpdate).entities ?? []) {
        for (const lines of entity.lines ?? []) {
          for (const p of segments(lines)) box.expandByPoint(new THREE.Vector3(p.x, p.y, p.z));
        }
      }
    }
    if (box.isEmpty()) return;
    this.framed = true;
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (Math.max(0.4, sphere.radius) * this.room) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    const away = Math.min(distance, 12);
    this.controls.target.copy(sphere.center);
    this.camera.position.copy(sphere.center).addScaledVector(directionTo(sphere.center, away, bodies, all, this.camera), away);
    this.controls.update();
  }

  /** Frames that are elsewhere at the start, in the middle or at the end. */
  private movingFrames(): Set<string> {
    const moving = new Set<string>(), topic = this.recording.topics.get("/tf");
    if (!topic || topic.length === 0) return moving;
    const first = new Map((topic.message(0) as FrameTransforms).transforms.map((one) => [one.child_frame_id, JSON.stringify(one.translation) + JSON.stringify(one.rotation)]));
    for (const index of [topic.length >> 1, topic.length - 1]) {
      for (const one of (topic.message(index) as FrameTransforms).transforms) {
        if (first.get(one.child_frame_id) !== JSON.stringify(one.translation) + JSON.stringify(one.rotation)) moving.add(one.child_frame_id);
      }
    }
    return moving;
  }

  private addLights(): void {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f98, 1.7));
    const sun = new THREE.DirectionalLight(0xffffff, 2.1);
    sun.position.set(2.5, -2, 5);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    sun.shadow.radius = 5;
    sun.shadow.bias = -0.0005;
    Object.assign(sun.shadow.camera, { left: -2.5, right: 2.5, top: 2.5, bottom: -2.5, near: 0.5, far: 12 });
    this.scene.add(sun);
    const floor = new THREE.Mesh(new THREE.PlaneGeometry(40, 40), new THREE.ShadowMaterial({ opacity: 0.16 }));
    floor.receiveShadow = true;
    this.scene.add(floor);
  }

  private applyTheme(): void {
    this.scene.background = new THREE.Color(this.page.colour("--stage"));
    this.grid.removeFromParent();
    this.grid.dispose();
    this.grid = new THREE.GridHelper(8, 32, this.page.colour("--grid-strong"), this.page.colour("--grid-3d"));
    this.grid.rotation.x = Math.PI / 2;
    this.grid.position.z = -0.002;
    this.scene.add(this.grid);
    this.overlays.applyTheme();
    this.stale = true;
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.parent;
    if (width === 0 || height === 0) return;
    this.renderer?.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.overlays.resize(width, height);
    this.stale = true;
  }
}
