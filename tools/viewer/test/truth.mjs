// SPDX-License-Identifier: BSD-3-Clause
// What the page says of a run is so: depths, warnings, refusals, which run it is; and who is let in.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { once } from "node:events";
import { createServer } from "node:http";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { promisify } from "node:util";
import { WebSocketServer } from "ws";
import { connect, kDiagram, serve } from "./live.mjs";
import { newContext, openPage } from "./page.mjs";

const run = promisify(execFile);
const quiet = ["--no-progress", "--log-level", "off"];

/** A run whose expectations are not met ends with 3. */
const runMissed = (simulator, args) => run(simulator, args).then(
  () => assert.fail("expected status 3"), (error) => assert.equal(error.code, 3, error.stderr));

/** Types into a parameter's field and presses Enter; the field keeps the focus. */
async function enter(page, name, value) {
  await page.evaluate(() => window.oca.selectNumber(3));
  const field = page.locator(".knob", { hasText: name }).locator("input[type=number]");
  await field.fill(String(value));
  await field.press("Enter");
  return field;
}

/** A server of foxglove.websocket.v1 whose time (s) the test sets; always session "1". */
async function fakeServer() {
  const server = new WebSocketServer({ port: 0, host: "127.0.0.1", handleProtocols: () => "foxglove.websocket.v1" });
  await once(server, "listening");
  const clients = new Map();
  server.on("connection", (socket) => {
    socket.send(JSON.stringify({ op: "serverInfo", name: "fake", capabilities: [], sessionId: "1", metadata: { start_epoch_ns: "0" } }));
    socket.send(JSON.stringify({ op: "advertise", channels: [{ id: 0, topic: "/plant/position", encoding: "json", schemaName: "p", schema: "{}" }] }));
    socket.on("message", (data) => {
      const { op, subscriptions } = JSON.parse(data);
      if (op === "subscribe") clients.set(socket, subscriptions[0].id);
    });
    socket.on("close", () => clients.delete(socket));
  });
  const send = (time) => {
    for (const [socket, id] of clients) {
      const head = Buffer.alloc(13);
      head[0] = 1;
      head.writeUInt32LE(id, 1);
      head.writeBigUInt64LE(BigInt(Math.round(time * 1e9)), 5);
      socket.send(Buffer.concat([head, Buffer.from(JSON.stringify({ a1: time }))]));
    }
  };
  return { url: `ws://127.0.0.1:${server.address().port}/`, clients, send, close: () => server.close() };
}

async function testRestart({ test, browser, simulator, viewer, errorsOf }) {
  await test("a page goes on by itself when its simulator is started again", async () => {
    const first = await serve(simulator, ["run", kDiagram, "--live=0", ...quiet]);
    const { page, problems } = await openPage(browser, first.url);
    await page.waitForFunction(() => window.oca.recording.end > 2);
    await page.evaluate(() => (window.before = window.oca.recording));
    await first.stop();
    await page.waitForFunction(() => /is gone/.test(document.getElementById("message").textContent));
    const second = await serve(simulator, ["run", kDiagram, `--live=${new URL(first.url).port}`, "-s", "parameters.force_gain=2", ...quiet]);
    await page.waitForFunction(() => window.oca.recording !== window.before && window.oca.recording.end > 0.3);
    const end = await page.evaluate(() => window.oca.recording.end);
    await page.waitForFunction((time) => window.oca.player.time > time + 0.3, end);
    assert.ok(await page.evaluate(() => document.getElementById("message").hidden));
    await page.waitForFunction(() => window.oca.plots.data("Final joints")?.[0].length > 10);
    const gain = page.locator(".knob", { hasText: "force_gain" }).locator("input[type=number]");
    assert.equal(await gain.inputValue(), "2");
    // What the lost connection says on the console is no fault of the page.
    assert.deepEqual(errorsOf(problems).filter((one) => !/ERR_CONNECTION_REFUSED|WebSocket/.test(one)), []);
    await page.context().close();
    await second.stop();
  });
  await test("time that goes back is another run, whatever its session is called", async () => {
    const server = await fakeServer();
    const context = await newContext(browser);
    const page = await context.newPage();
    await page.goto(`${pathToFileURL(viewer).href}?ws=${encodeURIComponent(server.url)}`);
    const send = setInterval(() => server.send((time += 0.05)), 20);
    let time = 100;
    await page.waitForFunction(() => window.oca?.recording.end > 101);
    time = 1;
    await page.waitForFunction(() => window.oca.recording.end > 1.5 && window.oca.recording.end < 50);
    const end = await page.evaluate(() => window.oca.player.time);
    await page.waitForFunction((before) => window.oca.player.time > before + 0.5 && window.oca.player.time < 50, end);
    clearInterval(send);
    server.close();
    await context.close();
  });
}

async function testRefusal({ test, browser, simulator, errorsOf }) {
  await test("a change that is refused is said to be, and the value goes back", async () => {
    const { url, stop, errors } = await serve(simulator, ["run", kDiagram, "--live=0", ...quiet]);
    const { page, problems } = await openPage(browser, url);
    const field = await enter(page, "max_distance", -1);
    const notice = page.locator("#notices .error");
    await notice.waitFor();
    assert.match(await notice.textContent(), /change refused: .*max_distance.*-1/s);
    await page.waitForFunction(() => [...document.querySelectorAll(".knob")].find((one) => one.textContent.includes("max_distance"))
      .querySelector("input[type=number]").value === "0.3");
    assert.ok(await field.evaluate((one) => one === document.activeElement));
    assert.match(errors(), /change refused/);
    await notice.click();
    assert.equal(await notice.count(), 0);
    await enter(page, "max_distance", 0.25);
    const { client, next } = connect(url);
    await next("serverInfo");
    client.subscribeParameterUpdates([]);
    await page.waitForTimeout(500);
    client.getParameters(["max_distance"], "m");
    assert.equal((await next("parameterValues", ({ id }) => id === "m")).parameters[0].value, 0.25);
    client.close();
    assert.deepEqual(errorsOf(problems), []);
    await page.context().close();
    await stop();
  });
}

async function testSaid({ test, browser, simulator }) {
  await test("what a live page says of the run is what it is by now", async () => {
    const { url, stop } = await serve(simulator, ["run", kDiagram, "--live=0", "--realtime=4", "-s", "parameters.print_infos=true", "--no-progress"]);
    const { page } = await openPage(browser, url);
    await page.evaluate(() => window.oca.selectNumber(1));
    const card = page.locator(".card", { hasText: "Nearest" }).locator("b");
    await card.waitFor();
    await page.waitForFunction(() => window.oca.recording.end > 7);
    await page.waitForFunction(() => /clear by 0\.2/.test(document.getElementById("badges").textContent));
    assert.ok(Number(await card.textContent()) < 0.3, await card.textContent());
    await page.evaluate(() => window.oca.selectNumber(4));
    const lines = () => page.locator(".log li").count();
    const logged = await lines();
    await page.waitForTimeout(2500);
    assert.ok(await lines() > logged, `${await lines()} lines`);
    await page.context().close();
    await stop();
  });
}

async function testWarnings({ test, browser, simulator, folder }) {
  const record = join(folder, "chatter.mcap"), report = join(folder, "chatter.html");
  await test("a report and a view say what the diagram was warned of, and so does a run of the record", async () => {
    await run(simulator, ["run", kDiagram, "--record", record, "--report", report, ...quiet]);
    const { url, stop } = await serve(simulator, ["view", record, "--port", "0"]);
    for (const address of [pathToFileURL(report).href, url]) {
      const { page } = await openPage(browser, address);
      const box = page.locator("#warnings");
      assert.ok(await box.isVisible());
      assert.match(await box.textContent(), /avoidance_report\.yaml:\d+:\d+: warning: .*the loop must chatter/);
      assert.match(await page.textContent("#badges"), /⚠ a warning/);
      assert.match(await page.textContent(".pane.log"), /warning {2}.*the loop must chatter/);
      await page.context().close();
    }
    await stop();
    const again = join(folder, "again.mcap");
    const { stderr } = await run(simulator, ["run", record, "--record", again, ...quiet]);
    assert.match(stderr, /avoidance_report\.yaml:\d+:\d+: warning: .*the loop must chatter/);
    assert.equal((await run(simulator, ["run", again, ...quiet])).stderr, stderr);
    const calm = await run(simulator, ["run", record, "-s", "parameters.relaxation_time=0.4", ...quiet]);
    assert.doesNotMatch(calm.stderr, /chatter/);
  });
  await test("a live page says what the diagram is warned of, as it is changed", async () => {
    const { url, stop, errors } = await serve(simulator, ["run", kDiagram, "--live=0", ...quiet]);
    const { page } = await openPage(browser, url);
    const box = page.locator("#warnings");
    await box.waitFor();
    assert.match(await box.textContent(), /the loop must chatter/);
    await enter(page, "relaxation_time", 0.4);
    await box.waitFor({ state: "hidden" });
    await enter(page, "relaxation_time", 0.01);
    await box.waitFor();
    assert.match(await box.textContent(), /the loop must chatter.*got 0\.01 s/);
    assert.equal(errors().match(/the loop must chatter/g).length, 2);
    await page.context().close();
    await stop();
  });
}

export async function testTruth(tools) {
  const { test, browser, simulator, folder, show } = tools;
  await test("the label in the scene is the least signed distance, and depth is negative", async () => {
    const report = join(folder, "contact.html");
    await runMissed(simulator, ["run", kDiagram, "-s", "parameters.avoid=false", "--report", report, ...quiet]);
    const { page } = await openPage(browser, pathToFileURL(report).href);
    const label = page.locator(".label.nearest");
    assert.ok(Math.abs(parseFloat(await label.textContent()) + 0.122) < 0.003, await label.textContent());
    assert.match(await page.textContent("#badges"), /✗ contact, 0\.122 m deep/);
    let deep = 0;
    for (const share of [0.1, 0.3, 0.38, 0.41, 0.44, 0.5, 0.8]) {
      const wanted = await page.evaluate((part) => {
        const { frames } = window.oca.player, time = frames[Math.round(part * (frames.length - 1))];
        const topic = window.oca.recording.topics.get("/distance/proximities");
        const { proximities } = topic.message(topic.indexAt(time));
        return { time, least: Math.min(...proximities.map(({ distance }) => distance)) };
      }, share);
      await show(page, wanted.time);
      assert.equal(await label.textContent(), `${wanted.least.toFixed(3)} m`);
      assert.equal(await label.evaluate((one) => one.classList.contains("contact")), wanted.least <= 0);
      if (wanted.least < 0) ++deep;
    }
    assert.ok(deep >= 2, `${deep} looks into the box`);
    await page.context().close();
  });
  await testRestart(tools);
  await testRefusal(tools);
  await testWarnings(tools);
  await testSaid(tools);
}

export async function testAccess({ test, browser, simulator, folder, errorsOf }) {
  /** Whether a page can open the WebSocket of a run. */
  const opens = (page, url) => page.evaluate((address) => new Promise((done) => {
    const socket = new WebSocket(address.replace("http", "ws"), ["foxglove.websocket.v1"]);
    socket.onopen = () => done(true);
    socket.onerror = () => done(false);
  }), url);
  await test("a page of another origin cannot reach a run, unless it is named", async () => {
    const foreign = createServer((_, answer) => answer.end("<title>evil</title>")).listen(0, "127.0.0.1");
    await once(foreign, "listening");
    const origin = `http://127.0.0.1:${foreign.address().port}`;
    for (const [args, wanted] of [[[], false], [["--live-origin", "foxglove"], false], [["--live-origin", origin], true]]) {
      const { url, stop, errors } = await serve(simulator, ["run", kDiagram, "--live=0", ...args, ...quiet]);
      const page = await browser.newPage();
      await page.goto(origin);
      assert.equal(await opens(page, url), wanted);
      await page.goto("about:blank");
      assert.equal(await opens(page, url), false);
      await page.goto(url);
      assert.equal(await opens(page, url), true);
      if (!wanted) assert.match(errors(), new RegExp(`Origin; got '${origin}'.*--live-origin`));
      await page.close();
      await stop();
    }
    foreign.close();
  });
  await test("where others reach it, the page brings the token of its address", async () => {
    const record = join(folder, "run.mcap");
    for (const args of [["view", record, "--port", "0", "--address", "0.0.0.0"],
                        ["run", kDiagram, "--live=0", "--live-address", "0.0.0.0", ...quiet]]) {
      const { url, stop, errors } = await serve(simulator, args);
      assert.match(url, /\?token=[0-9a-f]{32}$/);
      const { page, problems } = await openPage(browser, url.replace("0.0.0.0", "127.0.0.1"));
      assert.deepEqual(errorsOf(problems), []);
      assert.match(errors(), /warning: 0\.0\.0\.0 can be reached from elsewhere/);
      assert.equal((await fetch(url.replace("0.0.0.0", "127.0.0.1").replace(/\?.*/, ""))).status, 403);
      await stop();
      if (args[0] === "run") {  // started again, it has another token: the page cannot know it
        const again = await serve(simulator, ["run", kDiagram, `--live=${new URL(url).port}`, "--live-address", "0.0.0.0", ...quiet]);
        await page.waitForFunction(() => /open the address that it printed/.test(document.getElementById("message").textContent));
        await again.stop();
      }
      await page.context().close();
    }
  });
}
