// SPDX-License-Identifier: BSD-3-Clause
import { App } from "./app";
import { byId, element } from "./page";

const kKeys: [keys: string, what: string][] = [
  ["Space", "play or pause"], ["← →", "a second back, forth"], [", .", "a frame back, forth"],
  ["Home End", "to the start, the end"], ["- +", "slower, faster"], ["1 … 6", "switch lines, arrows, paths, labels"],
  ["P S L R", "plots, summary, limits, parameters"], ["D", "dark or light"], ["?", "this list"],
];

export function bindKeys(app: App): void {
  const dialog = byId<HTMLDialogElement>("keys");
  const list = element("dl");
  for (const [keys, what] of kKeys) list.append(element("dt", "", keys), element("dd", "", what));
  dialog.replaceChildren(element("h2", "", "Keys"), list);
  dialog.onclick = () => dialog.close();
  byId("help").onclick = () => dialog.showModal();
  const { player } = app;
  const actions: Record<string, () => void> = {
    " ": () => player.toggle(),
    "ArrowLeft": () => player.seek(player.time - 1), "ArrowRight": () => player.seek(player.time + 1),
    ",": () => player.step(-1), ".": () => player.step(1),
    "Home": () => player.seek(player.start), "End": () => player.seek(player.end),
    "-": () => player.faster(-1), "+": () => player.faster(1),
    "p": () => app.selectNumber(0), "s": () => app.selectNumber(1), "l": () => app.selectNumber(2),
    "r": () => app.selectNumber(3), "d": () => app.page.toggle(), "?": () => dialog.showModal(),
  };
  App.layers.forEach((layer, i) => (actions[String(i + 1)] = () => app.turn(layer)));
  document.onkeydown = (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || dialog.open) return;
    if (event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement) return;
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  };
}
