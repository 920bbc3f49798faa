// SPDX-License-Identifier: BSD-3-Clause
// node test/screenshot.mjs REPORT.html OUT.png [WIDTHxHEIGHT] [THEME] [TAB] [TIME]: a picture of a report.
import { pathToFileURL } from "node:url";
import { launch, openPage } from "./page.mjs";

const [report, out, size = "1440x860", theme = "light", tab = "0", time] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const browser = await launch();
const url = report.startsWith("http") ? report : pathToFileURL(report).href;
const { page, problems, milliseconds } = await openPage(browser, `${url}?theme=${theme}`,
  { viewport: { width, height }, hasTouch: width < 800, isMobile: width < 800, deviceScaleFactor: width < 800 ? 2 : 1 });
await page.evaluate(([index, at]) => {
  window.oca.selectNumber(Number(index));
  if (at !== undefined && at !== null) window.oca.player.seek(Number(at));
}, [tab, time]);
await page.waitForTimeout(400);
await page.screenshot({ path: out });
await browser.close();
for (const problem of problems) console.error(problem);
console.log(`${out}: open after ${milliseconds} ms`);
process.exit(problems.some((problem) => problem.startsWith("error")) ? 1 : 0);
