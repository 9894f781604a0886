// A click in the picture goes to a world and chooses a body.
import type { App } from './main';
import { pickBody, pickCell } from './pick';

const CLICK_PIXELS = 5; // what moves farther is a drag

function click(app: App, x: number, y: number): void {
  const ray = app.stage.ray(x, y);
  const body = pickBody(app.worlds, ray);
  const cell = body?.cell ?? pickCell(app.worlds, ray);
  if (cell < 0) return;
  const other = cell !== app.chosen.cell;
  app.choose(cell, body?.row ?? -1);
  if (other) app.showCell(cell);
}

export function watchClicks(app: App, canvas: HTMLElement): void {
  let down: { x: number; y: number } | null = null;
  canvas.addEventListener('pointerdown', (event) => {
    down = { x: event.clientX, y: event.clientY };
  });
  canvas.addEventListener('pointerup', (event) => {
    if (down === null || Math.hypot(event.clientX - down.x, event.clientY - down.y) > CLICK_PIXELS) return;
    click(app, event.clientX, event.clientY);
  });
}
