// SPDX-License-Identifier: BSD-3-Clause
// What is beside the scene of a robot: sliders, tables, and the pairs of links in contact.
import { element } from "./page";
import { short } from "./plots";
import { jointValue, type Robot, type RobotJoint, type RobotWarning } from "./robot";

/** Told which links are pointed at, and which one is chosen. */
export interface Pointing { over(links: number[]): void; choose(link: number): void }

const kDigits = 4;
const limit = (value: number | null, none = "–"): string => (value === null ? none : String(Number(value.toPrecision(kDigits))));
const range = (lower: number | null, upper: number | null): string =>
  lower === null && upper === null ? "no limits" : `${limit(lower, "−∞")} … ${limit(upper, "∞")}`;
const unitOf = (joint: RobotJoint): string => (joint.type === "prismatic" ? "m" : "rad");

/** Whatever is `part` of a link's row: under the pointer the link shows. */
export function pointsAt(part: HTMLElement, links: number[], pointing: Pointing): void {
  part.onpointerenter = part.onfocus = () => pointing.over(links);
  part.onpointerleave = part.onblur = () => pointing.over([]);
}

/** A slider and a number for every position, in the order of the joints; mimics follow theirs. */
export class JointSliders {
  private readonly puts: ((values: readonly number[]) => void)[] = [];

  constructor(parent: HTMLElement, robot: Robot, private readonly move: (position: number, value: number) => void,
              private readonly pointing: Pointing) {
    const list = element("div", "joints");
    for (const joint of robot.joints) if (joint.type !== "fixed") list.append(this.row(robot, joint));
    if (this.puts.length === 0) list.append(element("p", "empty", "No joint of it moves."));
    parent.append(list);
  }

  put(values: readonly number[]): void {
    for (const put of this.puts) put(values);
  }

  private row(robot: Robot, joint: RobotJoint): HTMLElement {
    const row = element("label", "joint"), slider = element("input"), number = element("input");
    const leads = joint.mimics === null && joint.position !== null, position = joint.position ?? 0;
    const of = robot.positions[position]!;
    const ends = of.range.map((value) => (leads ? value : joint.multiplier * value + joint.offset)).sort((a, b) => a - b);
    slider.type = "range";
    [slider.min, slider.max, slider.step] = [String(ends[0]), String(ends[1]), "any"];
    number.type = "number";
    number.step = "any";
    slider.disabled = number.disabled = !leads;
    slider.setAttribute("aria-label", joint.name);
    number.setAttribute("aria-label", `${joint.name}, ${unitOf(joint)}`);
    slider.oninput = () => this.move(position, slider.valueAsNumber);
    number.onchange = () => { if (Number.isFinite(number.valueAsNumber)) this.move(position, number.valueAsNumber); };
    this.puts.push((values) => {
      const value = jointValue(joint, values);
      slider.value = String(value);
      number.value = String(Number(value.toPrecision(kDigits)));
      const beyond = value < (joint.lower ?? -Infinity) - 1e-9 || value > (joint.upper ?? Infinity) + 1e-9;
      row.classList.toggle("beyond", beyond);
    });
    const said = leads ? range(of.lower, of.upper) : `${limit(joint.multiplier)} · ${joint.mimics ?? ""}${joint.offset === 0 ? "" : ` + ${limit(joint.offset)}`}`;
    row.append(element("span", "name", joint.name), slider, number, element("span", "unit", unitOf(joint)),
               element("small", "", leads ? said : `follows ${said}`));
    pointsAt(row, [joint.child], this.pointing);
    return row;
  }
}

export function jointTable(parent: HTMLElement, robot: Robot, pointing: Pointing): void {
  const [table, body] = tableOf(["Joint", "Type", "Limits", "Speed", "Effort", "Acceleration", "From → to"]);
  for (const joint of robot.joints) {
    const row = body.insertRow(), fixed = joint.type === "fixed", unit = fixed ? "" : unitOf(joint);
    const force = joint.type === "prismatic" ? "N" : "Nm";
    const cell = (text: string): void => { row.append(element("td", "number", text)); };
    const measured = (value: number | null, of: string): void => cell(fixed ? "" : value === null ? "–" : `${limit(value)} ${of}`);
    row.append(element("th", "", joint.name));
    row.append(element("td", "", joint.mimics === null ? joint.type : `${joint.type}, mimics ${joint.mimics}`));
    cell(fixed ? "" : `${range(joint.lower, joint.upper)} ${joint.lower === null && joint.upper === null ? "" : unit}`);
    measured(joint.velocity, `${unit}/s`);
    measured(joint.effort, force);
    measured(joint.acceleration, `${unit}/s²`);
    row.append(element("td", "", `${robot.links[joint.parent]!.name} → ${robot.links[joint.child]!.name}`));
    choosable(row, joint.child, pointing);
  }
  parent.append(element("h3", "", `${robot.joints.length} joints, ${robot.positions.length} of them move on their own`), scrolling(table));
}

export function linkTable(parent: HTMLElement, robot: Robot, pointing: Pointing): HTMLTableRowElement[] {
  const [table, body] = tableOf(["Link", "Joint to it", "Collision shapes", "Drawn", "Mass"]);
  const rows = robot.links.map((link, i) => {
    const row = body.insertRow(), warnings = robot.warnings.filter(({ links }) => links.includes(i));
    const name = element("th", "", link.name);
    if (warnings.length > 0) {
      const mark = element("span", "mark", " ⚠");
      mark.title = warnings.map(({ text }) => text).join("\n");
      name.append(mark);
    }
    row.append(name, element("td", "", robot.joints.find(({ child }) => child === i)?.name ?? "none: the root"),
               element("td", "", counted(link.collisions)), element("td", "", counted(link.visuals)),
               element("td", "number", link.mass > 0 ? `${short(link.mass)} kg` : "–"));
    choosable(row, i, pointing);
    return row;
  });
  parent.append(scrolling(table));
  return rows;
}

/** What was warned of at load, over all tabs; those that speak of links show them. */
export function warningList(box: HTMLElement, warnings: readonly RobotWarning[], pointing: Pointing): void {
  box.hidden = warnings.length === 0;
  box.replaceChildren(element("summary", "", warnings.length === 1 ? "A warning" : `${warnings.length} warnings`));
  for (const { text, links } of warnings) {
    const line = element(links.length > 0 ? "button" : "p", "warning", `⚠ ${text}`);
    if (links.length > 0) {
      pointsAt(line, links, pointing);
      line.onclick = () => pointing.choose(links[0]!);
    }
    box.append(line);
  }
}

/** Own pairs that touch, and how many nobody looks at. */
export function contactList(parent: HTMLElement, robot: Robot, contacts: readonly [number, number][], pointing: Pointing): void {
  const looked = robot.own_pairs.length === 1 ? "the one pair of links that is checked" : `the ${robot.own_pairs.length} pairs of links that are checked`;
  const disabled = robot.srdf === null ? "no SRDF is given" : `the SRDF disables ${robot.disabled_pairs}`;
  parent.replaceChildren(element("p", contacts.length > 0 ? "touching" : "", contacts.length === 0 ? `None of ${looked} touches; ${disabled}.`
    : `${contacts.length} of ${looked} ${contacts.length === 1 ? "touches" : "touch"}; ${disabled}:`));
  for (const [a, b] of contacts) {
    const line = element("button", "pair", `${robot.links[a]!.name} – ${robot.links[b]!.name}`);
    pointsAt(line, [a, b], pointing);
    line.onclick = () => pointing.choose(b);
    parent.append(line);
  }
}

function counted(kinds: readonly string[]): string {
  const counts = new Map<string, number>();
  for (const kind of kinds) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  return [...counts].map(([kind, count]) => (count === 1 ? kind : `${count} × ${kind}`)).join(", ") || "–";
}

function tableOf(headings: string[]): [HTMLTableElement, HTMLTableSectionElement] {
  const table = element("table", "parts"), row = table.createTHead().insertRow();
  for (const heading of headings) row.append(element("th", "", heading));
  return [table, table.createTBody()];
}

function choosable(row: HTMLTableRowElement, link: number, pointing: Pointing): void {
  row.tabIndex = 0;
  pointsAt(row, [link], pointing);
  row.onclick = () => pointing.choose(link);
  row.onkeydown = (event) => { if (event.key === "Enter") pointing.choose(link); };
}

function scrolling(table: HTMLElement): HTMLElement {
  const box = element("div", "wide");
  box.append(table);
  return box;
}
