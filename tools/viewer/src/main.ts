// SPDX-License-Identifier: BSD-3-Clause
// One page, three sources: a record inside the page, a record at an address, a running simulator. A record is that of a run, or
// of a robot that stands still.
import "./style.css";
import { App } from "./app";
import { fromBase64, readMcap } from "./mcap_source";
import { Page } from "./page";
import { RobotApp } from "./robot_app";

const began = performance.now();
const page = new Page();

async function open(bytes: Uint8Array): Promise<void> {
  const recording = await readMcap(bytes);
  if (recording.topics.has("/robot")) {
    expose(new RobotApp(page, recording));
  } else {
    const app = new App(page);
    app.load(recording);
    expose(app);
  }
}

/** What tests look at. */
function expose(app: App | RobotApp): void {
  Object.assign(window, { oca: app, ocaLoadMilliseconds: performance.now() - began });
}

function askForFile(): void {
  page.message("Drop a record (.mcap) here.");
  document.ondragover = (event) => event.preventDefault();
  document.ondrop = (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    page.message("");
    file.arrayBuffer().then((data) => open(new Uint8Array(data))).catch(fail);
  };
}

function fail(error: unknown): void {
  page.message(`The record cannot be read: ${error instanceof Error ? error.message : String(error)}`);
}

async function start(): Promise<void> {
  const embedded = document.getElementById("oca-record");
  const asked = new URLSearchParams(location.search);
  // What let this page in lets in what it asks for.
  const token = asked.has("token") ? `?token=${encodeURIComponent(asked.get("token")!)}` : "";
  const source = document.querySelector<HTMLMetaElement>("meta[name=oca-source]")?.content;
  if (embedded) {
    await open(await fromBase64(embedded.textContent!.trim()));
    embedded.remove();
  } else if (source === "live" || asked.has("ws")) {
    const app = new App(page);
    app.follow(asked.get("ws") ?? `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/${token}`);
    expose(app);
  } else if (source || asked.has("mcap")) {
    const answer = await fetch(asked.get("mcap") ?? `${source!}${token}`);
    if (!answer.ok) throw new Error(`${answer.url}: ${answer.status} ${answer.statusText}`);
    await open(new Uint8Array(await answer.arrayBuffer()));
  } else {
    askForFile();
  }
}

start().catch(fail);
