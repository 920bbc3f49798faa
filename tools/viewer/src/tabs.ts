// SPDX-License-Identifier: BSD-3-Clause
// What every page has: tabs beside the scene, and switches of what the scene shows.
import { byId, element } from "./page";

export class Tabs<Tab extends string> {
  readonly panes = new Map<Tab, HTMLElement>();

  /** Tabs of these names in place of those that were there; the first one is seen. */
  constructor(readonly names: readonly Tab[], private readonly selected: () => void = () => {}) {
    byId("tabs").replaceChildren();
    byId("panes").replaceChildren();
    for (const tab of names) {
      const button = element("button", "", tab), pane = element("div", `pane ${tab.toLowerCase()}`);
      button.setAttribute("role", "tab");
      pane.setAttribute("role", "tabpanel");
      button.onclick = () => this.select(tab);
      byId("tabs").append(button);
      byId("panes").append(pane);
      this.panes.set(tab, pane);
    }
    this.mark(names[0]!);
  }

  pane(tab: Tab): HTMLElement { return this.panes.get(tab)!; }

  select(tab: Tab): void {
    this.mark(tab);
    this.selected();
  }
  selectNumber(index: number): void { if (this.names[index]) this.select(this.names[index]); }

  private mark(tab: Tab): void {
    for (const [name, pane] of this.panes) pane.hidden = name !== tab;
    for (const button of byId("tabs").children) button.setAttribute("aria-selected", String(button.textContent === tab));
  }
}

/** Buttons over the scene that `turn` something on and off; key 1 stands for the first. All begin as `isOn` says. */
export function makeSwitches<Layer extends string>(list: readonly [layer: Layer, name: string][], turn: (layer: Layer) => void,
                                                   isOn: (layer: Layer) => boolean): void {
  byId("switches").replaceChildren();
  list.forEach(([layer, name], i) => {
    const button = element("button", `switch ${layer}`, name);
    button.dataset["layer"] = layer;
    button.title = `${name} (${i + 1})`;
    button.setAttribute("aria-pressed", String(isOn(layer)));
    button.onclick = () => turn(layer);
    byId("switches").append(button);
  });
}

export function markSwitch(layer: string, on: boolean): void {
  byId("switches").querySelector(`[data-layer=${layer}]`)!.setAttribute("aria-pressed", String(on));
}
