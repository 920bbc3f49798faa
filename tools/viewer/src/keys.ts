// SPDX-License-Identifier: BSD-3-Clause
import { App } from "./app";
import { byId, element, type Page } from "./page";

type Keys = [keys: string, what: string][];
type Actions = Record<string, () => void>;

const kKeys: Keys = [
  ["Space", "play or pause"], ["← →", "a second back, forth"], [", .", "a frame back, forth"],
  ["Home End", "to the start, the end"], ["- +", "slower, faster"], ["1 … 6", "switch lines, arrows, paths, labels"],
  ["P S L R", "plots, summary, limits, parameters"],
];

export function bindKeys(app: App): void {
  const { player } = app;
  const actions: Actions = {
    " ": () => player.toggle(),
    "ArrowLeft": () => player.seek(player.time - 1), "ArrowRight": () => player.seek(player.time + 1),
    ",": () => player.step(-1), ".": () => player.step(1),
    "Home": () => player.seek(player.start), "End": () => player.seek(player.end),
    "-": () => player.faster(-1), "+": () => player.faster(1),
    "p": () => app.selectNumber(0), "s": () => app.selectNumber(1), "l": () => app.selectNumber(2),
    "r": () => app.selectNumber(3),
  };
  App.layers.forEach((layer, i) => (actions[String(i + 1)] = () => app.turn(layer)));
  listen(app.page, kKeys, actions);
}

/** Does what keys stand for, also those of every page, and lists them all where somebody asks. */
export function listen(page: Page, keys: Keys, own: Actions): void {
  const dialog = byId<HTMLDialogElement>("keys");
  const list = element("dl");
  for (const [key, what] of [...keys, ["D", "dark or light"], ["?", "this list"]] as Keys) {
    list.append(element("dt", "", key), element("dd", "", what));
  }
  dialog.replaceChildren(element("h2", "", "Keys"), list);
  dialog.onclick = () => dialog.close();
  byId("help").onclick = () => dialog.showModal();
  const actions: Actions = { ...own, "d": () => page.toggle(), "?": () => dialog.showModal() };
  document.onkeydown = (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || dialog.open) return;
    if (event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement) return;
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  };
}
