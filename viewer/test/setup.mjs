// What the tests of pages share: the program, a folder for what they make, and a browser. ctest sets
// MANYWORLDS_CLI=program CHROMIUM=browser PLAYWRIGHT=.../index.mjs.
import assert from 'node:assert/strict';
import { existsSync, mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const { MANYWORLDS_CLI, CHROMIUM, PLAYWRIGHT } = process.env;
const { chromium } = await import(PLAYWRIGHT ?? 'playwright-core');

export const program = MANYWORLDS_CLI;

// A new one; whoever asks for it removes it.
export function makeFolder(name) {
  return mkdtempSync(join(tmpdir(), `manyworlds-${name}-`));
}

// A page with what it complains of; so it does where it asks for what is not `allowed`.
export async function openPage(browser, url, { allowed = (asked) => asked === url, ...options } = {}) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const complaints = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('request', (request) => {
    if (!allowed(request.url())) complaints.push(`asks for ${request.url()}`);
  });
  await page.goto(url);
  return { context, page, complaints };
}

// With { gl: true } for pages that draw by WebGL, in software: it slows all others, too.
export function launchBrowser({ gl = false } = {}) {
  assert.ok(CHROMIUM && existsSync(CHROMIUM), 'no Chromium was found: apt-get install chromium');
  const drawing = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
  return chromium.launch({ executablePath: CHROMIUM, args: ['--no-sandbox', ...(gl ? drawing : [])] });
}
