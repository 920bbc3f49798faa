// SPDX-License-Identifier: BSD-3-Clause
import { element } from "./page";
import type { LiveSource, Parameter } from "./live_source";

const kDigits = 4;
const kAnswerWithin = 400;  // ms from a change until what came of it is shown

/** Sliders for the parameters of a running diagram. */
export class Knobs {
  private readonly setters = new Map<string, (value: unknown) => void>();
  private made = "";
  private readonly held = new Set<string>();  // what somebody is changing just now
  private later: Parameter[] | undefined;     // other sliders that wait for it

  constructor(private readonly parent: HTMLElement, private readonly live: LiveSource) {}

  /** The bounds of a parameter that the simulator knows; null: none. */
  private rangeOf(name: string): [number | null, number | null] {
    try {
      const range: unknown = JSON.parse(this.live.recording.about(name, "oca.ranges") ?? "null");
      if (Array.isArray(range)) return range as [number | null, number | null];
    } catch { /* as if nobody knew */ }
    return [null, null];
  }

  /** Follows what the simulator says that the values are; other parameters are other sliders. */
  show(list: Parameter[]): void {
    const wanted = JSON.stringify(list.map(({ name, value }) => [name, typeof value, this.rangeOf(name)]));
    // Under a hand they stay: a value that is half typed would be lost with its field.
    this.later = wanted !== this.made && this.held.size > 0 ? list : undefined;
    if (wanted !== this.made && !this.later) {
      this.made = wanted;
      this.parent.replaceChildren();
      this.setters.clear();
    }
    for (const { name, value } of list) {
      const set = this.setters.get(name);
      if (set) set(value);
      else if (this.later) continue;
      else if (typeof value === "boolean") this.addSwitch(name, value);
      else if (typeof value === "number") this.addSlider(name, value);
    }
  }

  private addSwitch(name: string, value: boolean): void {
    const row = element("label", "knob");
    const box = element("input");
    box.type = "checkbox";
    box.checked = value;
    box.onchange = () => this.live.set(name, box.checked);
    row.append(element("span", "", name), box);
    this.parent.append(row);
    this.setters.set(name, (to) => (box.checked = to === true));
  }

  /** As far as the parameter may go; where nobody says, from 0 (or minus) to three times what it was. */
  private addSlider(name: string, value: number): void {
    const row = element("label", "knob");
    const slider = element("input"), number = element("input");
    slider.type = "range";
    const reach = 3 * Math.abs(value) || 1;
    const [lower, upper] = this.rangeOf(name);
    const low = lower ?? (value < 0 ? -reach : 0), high = upper ?? Math.max(reach, low + reach);
    [slider.min, slider.max, slider.step] = [String(low), String(high), String((high - low) / 300)];
    number.min = lower === null ? "" : String(lower);
    number.max = upper === null ? "" : String(upper);
    number.type = "number";
    number.step = "any";
    let told = value;
    const put = (to: number): void => {
      slider.value = String(to);
      number.value = String(Number(to.toPrecision(kDigits)));
    };
    // Nothing moves under a hand; once it is gone, what the simulator says counts.
    const letGo = (): void => {
      this.held.delete(name);
      setTimeout(() => { if (!this.held.has(name)) put(told); }, kAnswerWithin);
      if (this.later && this.held.size === 0) this.show(this.later);
    };
    slider.oninput = () => {
      this.held.add(name);
      number.value = String(Number(Number(slider.value).toPrecision(kDigits)));
      this.live.set(name, Number(number.value));
    };
    slider.onchange = number.onblur = letGo;
    number.oninput = () => this.held.add(name);
    number.onchange = () => {
      if (Number.isFinite(number.valueAsNumber)) {
        slider.value = number.value;
        this.live.set(name, number.valueAsNumber);
      }
      letGo();
    };
    put(value);
    row.append(element("span", "", name), slider, number);
    this.parent.append(row);
    this.setters.set(name, (to) => {
      if (typeof to !== "number") return;
      told = to;
      if (!this.held.has(name)) put(to);
    });
  }
}
