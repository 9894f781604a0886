// The scale of the colours, with numbers and unit, below the title: on pages, in pictures and in films.
import type { Coloring } from './coloring';
import { scaleStops } from './colors';
import { element } from './elements';

const TICKS = [0, 0.25, 0.5, 0.75, 1]; // of the scale's length

// Three digits, without what says nothing: 0.5, 12.3, 45600.
export function shortNumber(x: number): string {
  if (!Number.isFinite(x)) return '–';
  const text = String(Number(x.toPrecision(3)));
  return text.startsWith('-') ? `−${text.slice(1)}` : text;
}

export class Legend {
  private stops: [number, string][] = [];
  private shown = '';

  tell(coloring: Coloring): void {
    const { scale, words } = coloring;
    element('legend').hidden = scale === null && words === null;
    if (scale !== null) {
      this.stops = scaleStops;
      this.write(scale.unit === '' ? scale.name : `${scale.name}, ${scale.unit}`,
        TICKS.map((x) => [x, shortNumber(scale.at(x))]));
    } else if (words !== null) {
      const part = 1 / words.length;
      this.stops = words.flatMap(({ color }, i): [number, string][] => [[i * part, color], [(i + 1) * part, color]]);
      this.write('', words.map(({ text }, i) => [(i + 0.5) * part, text]));
    }
  }

  private write(name: string, ticks: [number, string][]): void {
    const key = JSON.stringify([name, ticks, this.stops]);
    if (key === this.shown) return;
    this.shown = key;
    element('legend-name').textContent = name;
    element('scale').style.background =
      `linear-gradient(90deg, ${this.stops.map(([x, color]) => `${color} ${100 * x}%`).join(', ')})`;
    element('ticks').replaceChildren(...ticks.map(([x, text]) => {
      const tick = document.createElement('span');
      tick.textContent = text;
      tick.style.left = `${100 * x}%`;
      tick.style.transform = `translateX(-${100 * x}%)`; // those at the ends stay within them
      return tick;
    }));
  }

  // The bar alone, where the page has it; its words are written as all others are.
  paint(pen: OffscreenCanvasRenderingContext2D, ratio: number): void {
    const box = element('scale').getBoundingClientRect();
    if (box.width === 0) return;
    const fill = pen.createLinearGradient(ratio * box.left, 0, ratio * box.right, 0);
    for (const [x, color] of this.stops) fill.addColorStop(x, color);
    pen.save();
    pen.fillStyle = fill;
    pen.fillRect(ratio * box.left, ratio * box.top, ratio * box.width, ratio * box.height);
    pen.restore();
  }
}
