// SPDX-License-Identifier: BSD-3-Clause
// The page in Debian's Chromium.
import { chromium } from "playwright-core";

export const kChromium = process.env.OCA_CHROMIUM ?? "/usr/bin/chromium";

/** How long the page may take to do something. It says nothing of its speed: where every processor is taken, drawing without
    a graphics card leaves it little time for anything else. */
const kPatience = 180000;  // ms

export async function newContext(browser, options = {}) {
  const context = await browser.newContext(options);
  context.setDefaultTimeout(kPatience);
  return context;
}

/** `graphics`: arguments that say what draws. */
export async function launch(graphics = ["--enable-unsafe-swiftshader"]) {
  return chromium.launch({ executablePath: kChromium, headless: true, args: [...graphics, "--no-sandbox", "--disable-dev-shm-usage"] });
}
export const kNoWebGL = ["--disable-gpu", "--disable-software-rasterizer", "--disable-3d-apis"];

/** Opens the page and waits until it shows something; `problems` gathers what the console says. */
export async function openPage(browser, url, options = {}) {
  const context = await newContext(browser, { viewport: { width: 1440, height: 860 }, deviceScaleFactor: 1, ...options });
  const page = await context.newPage();
  const problems = [];
  page.on("console", (message) => {
    if (message.type() === "error" || message.type() === "warning") problems.push(`${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (error) => problems.push(`error: ${error.message}`));
  const began = Date.now();
  await page.goto(url);
  await page.waitForFunction(() => window.oca && (window.oca.robot || (window.oca.plots && window.oca.player.end > 0)));
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return { page, problems, milliseconds: Date.now() - began };
}

/** Puts a record into the built page, as `simulator run --report` does. */
export function embed(page, record) {
  const text = Buffer.from(record).toString("base64");
  return page.replace("<!--oca:source-->", () => `<script id="oca-record" type="application/octet-stream;base64">${text}</script>`);
}
