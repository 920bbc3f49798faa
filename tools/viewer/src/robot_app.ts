// SPDX-License-Identifier: BSD-3-Clause
import { Contacts } from "./contacts";
import { listen } from "./keys";
import type { SceneEntity, SceneUpdate } from "./messages";
import { byId, element, type Page } from "./page";
import type { Recording } from "./recording";
import { linkPoses, type LinkPose, type Robot } from "./robot";
import { contactList, JointSliders, jointTable, linkTable, warningList, type Pointing } from "./robot_panels";
import { SceneView, type Solids } from "./scene_view";
import { makeSwitches, markSwitch, Tabs } from "./tabs";

type Layer = "visuals" | "collisions" | "labels";
const kLayers: [layer: Layer, name: string][] = [["visuals", "Visuals"], ["collisions", "Collision shapes"], ["labels", "Labels"]];
const kSolids: Record<Exclude<Layer, "labels">, Solids> = { visuals: "/scene/robots", collisions: "/scene/collisions" };
const kTabs = ["Joints", "Links"] as const;
const kRoom = 1.25;  // it will move

/** The page of a robot that no run moves (`simulator robot show`): sliders move its joints. */
export class RobotApp implements Pointing {
  readonly robot: Robot;
  readonly view: SceneView;
  values: number[];
  contacts: [number, number][] = [];
  poses: LinkPose[] = [];
  private readonly tabs = new Tabs(kTabs);
  private readonly sliders: JointSliders;
  private readonly rows: HTMLTableRowElement[];
  private readonly touching: Contacts;
  private readonly contactBox = element("div", "contacts");
  private labels = true;
  private pointed: number[] = [];
  private chosen: number | undefined;

  constructor(readonly page: Page, readonly recording: Recording) {
    this.robot = recording.last("/robot") as Robot;
    this.values = this.robot.positions.map(({ start }) => start);
    byId("bar").hidden = true;
    this.view = new SceneView(page, byId("view"), byId("labels"), recording);
    this.view.room = kRoom;
    this.touching = new Contacts(collisionsOf(this.robot, recording), this.robot.own_pairs);
    this.sayWhat();
    const joints = this.tabs.pane("Joints");
    joints.append(this.buttons(), this.contactBox);
    this.sliders = new JointSliders(joints, this.robot, (position, value) => this.move(position, value), this);
    jointTable(joints, this.robot, this);
    this.rows = linkTable(this.tabs.pane("Links"), this.robot, this);
    makeSwitches(kLayers, (layer) => this.turn(layer), (layer) => this.isOn(layer));
    listen(page, [["1 2 3", "visuals, collision shapes, labels"], ["J L", "joints, links"], ["0", "start posture"]], {
      "1": () => this.turn("visuals"), "2": () => this.turn("collisions"), "3": () => this.turn("labels"),
      "j": () => this.tabs.select("Joints"), "l": () => this.tabs.select("Links"), "0": () => this.toStart(),
    });
    this.followPointer();
    page.onTheme(() => this.paintAll());
    this.view.show(0);
    this.set(this.values);
    const loop = (): void => {
      this.view.render();
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  selectNumber(index: number): void { this.tabs.selectNumber(index); }

  /** Puts the robot at positions, one a slider. */
  set(values: readonly number[]): void {
    this.values = [...values];
    this.poses = linkPoses(this.robot, this.values);
    this.poses.forEach(({ p, q }, link) => this.view.place({
      parent_frame_id: "world", child_frame_id: this.robot.links[link]!.frame, translation: p, rotation: q }));
    this.sliders.put(this.values);
    const before = JSON.stringify(this.contacts), unsaid = this.contactBox.childElementCount === 0;
    this.contacts = this.touching.at(this.poses);
    if (unsaid || JSON.stringify(this.contacts) !== before) {
      contactList(this.contactBox, this.robot, this.contacts, this);
      this.showBadges();
    }
    this.paintAll();
  }

  over(links: number[]): void {
    this.pointed = links;
    this.paintAll();
  }

  /** Holds on to a link; to no longer, if it is that one. */
  choose(link: number): void {
    this.chosen = this.chosen === link ? undefined : link;
    this.paintAll();
    if (this.chosen !== undefined) this.rows[link]!.scrollIntoView({ block: "nearest" });
  }

  turn(layer: Layer): void {
    if (layer === "labels") byId("labels").classList.toggle("off", !(this.labels = !this.labels));
    else this.view.turn(kSolids[layer], !this.isOn(layer));
    markSwitch(layer, this.isOn(layer));
  }

  private isOn(layer: Layer): boolean { return layer === "labels" ? this.labels : this.view.isOn(kSolids[layer]); }

  private move(position: number, value: number): void {
    this.set(this.values.map((old, i) => (i === position ? value : old)));
  }

  private toStart(): void { this.set(this.robot.positions.map(({ start }) => start)); }

  private toAnywhere(): void {
    this.set(this.robot.positions.map(({ range: [low, high] }) => low + Math.random() * (high - low)));
  }

  private sayWhat(): void {
    const { name, file } = this.robot;
    document.title = `${name} – OCA`;
    byId("title").textContent = name;
    byId("subtitle").textContent = file;
    warningList(byId("warnings"), this.robot.warnings, this);
  }

  private buttons(): HTMLElement {
    const row = element("div", "postures");
    for (const [text, act] of [["Start posture", () => this.toStart()], ["A random posture", () => this.toAnywhere()]] as const) {
      const button = element("button", "", text);
      button.onclick = act;
      row.append(button);
    }
    return row;
  }

  private showBadges(): void {
    const badge = (className: string, text: string): HTMLElement => element("span", `badge ${className}`, text);
    const { warnings, positions } = this.robot, count = this.contacts.length;
    byId("badges").replaceChildren(
      badge("", `${positions.length} joints that move`),
      count === 0 ? badge("good", "✓ no own links touch") : badge("bad", `✗ ${count} own pair${count === 1 ? "" : "s"} in contact`),
      ...(warnings.length > 0 ? [badge("warn", `⚠ ${warnings.length === 1 ? "a warning" : `${warnings.length} warnings`}`)] : []));
  }

  /** Colours: what is pointed at or chosen, what touches; labels: the names of those, and a mark at links with a warning. */
  private paintAll(): void {
    const touching = new Set(this.contacts.flat());
    this.robot.links.forEach(({ frame, name }, link) => {
      const shown = this.pointed.includes(link) || this.chosen === link;
      const warned = this.robot.warnings.some(({ links }) => links.includes(link));
      this.view.paint(frame, shown ? this.page.colour("--accent") : touching.has(link) ? this.page.colour("--bad") : undefined);
      const marks = [...(warned ? ["⚠"] : []), ...(shown ? [name] : [])];
      this.view.label(frame, marks.join(" "), warned ? "warned" : "pointed");
      this.rows[link]!.classList.toggle("on", shown);
    });
  }

  /** A link under the pointer shows, a click holds on to it; a drag turns the view. */
  private followPointer(): void {
    const { canvas } = this.view;
    const at = (event: PointerEvent): number => {
      const box = canvas.getBoundingClientRect();
      const frame = this.view.frameAt(event.clientX - box.left, event.clientY - box.top)?.frame;
      return this.robot.links.findIndex((link) => link.frame === frame);
    };
    let down: PointerEvent | undefined, last = -1;
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons !== 0) return;
      const link = at(event);
      if (link === last) return;
      last = link;
      this.over(link < 0 ? [] : [link]);
    });
    canvas.addEventListener("pointerleave", () => { last = -1; this.over([]); });
    canvas.addEventListener("pointerdown", (event) => (down = event));
    canvas.addEventListener("pointerup", (event) => {
      const moved = down ? Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) : Infinity;
      const link = moved < 4 ? at(event) : -1;
      if (link >= 0) this.choose(link);
    });
  }
}

/** The collision shapes of each link, by its number. */
function collisionsOf(robot: Robot, recording: Recording): (SceneEntity | undefined)[] {
  const update = recording.last("/scene/collisions") as SceneUpdate | undefined;
  const byFrame = new Map((update?.entities ?? []).map((entity) => [entity.frame_id, entity]));
  return robot.links.map(({ frame }) => byFrame.get(frame));
}
