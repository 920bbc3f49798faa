// SPDX-License-Identifier: BSD-3-Clause
// The few things every part of the page needs of the document.

const kNotices = 4;
const kNoticeFor = 20_000;  // ms

/** Text only ever enters the page as text, never as markup: records may come from anybody. */
export function element<K extends keyof HTMLElementTagNameMap>(tag: K, className = "", text = ""): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text) made.textContent = text;
  return made;
}

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`page: element; got none called ${id}; expected one`);
  return found as T;
}

/** A drawing of 24 x 24 from one path. */
export function icon(path: string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  const shape = document.createElementNS(svg.namespaceURI, "path") as SVGPathElement;
  shape.setAttribute("d", path);
  svg.append(shape);
  return svg;
}

/** Dark or light, and the colours of the style sheet that canvases need. */
export class Page {
  readonly font = "system-ui, sans-serif";
  private colours = new Map<string, string>();
  private readonly listeners: (() => void)[] = [];

  constructor() {
    const wanted = new URLSearchParams(location.search).get("theme");
    const dark = wanted ? wanted === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    document.documentElement.dataset["theme"] = dark ? "dark" : "light";
    byId("theme").append(icon("M12 3a9 9 0 1 0 0 18zM12 1.5a10.5 10.5 0 1 1 0 21 10.5 10.5 0 0 1 0-21z"));
    byId("theme").onclick = () => this.toggle();
  }

  get dark(): boolean { return document.documentElement.dataset["theme"] === "dark"; }

  toggle(): void {
    document.documentElement.dataset["theme"] = this.dark ? "light" : "dark";
    this.colours.clear();
    for (const listener of this.listeners) listener();
  }

  onTheme(listener: () => void): void { this.listeners.push(listener); }

  colour(name: string): string {
    let value = this.colours.get(name);
    if (value === undefined) {
      value = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
      this.colours.set(name, value);
    }
    return value;
  }

  /** A line that goes away by itself, or at a click; said again, it stays longer. */
  notice(text: string, kind: "info" | "warning" | "error"): void {
    const notices = byId("notices");
    [...notices.children].find((one) => one.textContent === text)?.remove();
    const line = element("button", kind, text);
    line.title = "Close";
    line.onclick = () => line.remove();
    notices.append(line);
    while (notices.children.length > kNotices) notices.firstElementChild!.remove();
    setTimeout(() => line.remove(), kNoticeFor);
  }

  /** A line for the user; empty hides it. */
  message(text: string): void {
    byId("message").textContent = text;
    byId("message").hidden = text === "";
  }
}
