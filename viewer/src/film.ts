// Frames of a page for pictures and films: each drawn when it is asked for, of exactly its moment, with the page's
// words on it. Who asks is src/film; a page whose address has #film draws nothing else.
import type { App } from './main';

const JPEG_QUALITY = 0.95;

export class Film {
  private readonly canvas: OffscreenCanvas;
  private readonly pen: OffscreenCanvasRenderingContext2D;

  private constructor(private readonly app: App) {
    const { width, height } = app.stage.renderer.domElement;
    this.canvas = new OffscreenCanvas(width, height);
    // What is drawn is read back at once: no use to keep it on a graphics card.
    const pen = this.canvas.getContext('2d', { alpha: false, willReadFrequently: true });
    if (pen === null) throw new Error('no canvas for frames can be made');
    this.pen = pen;
  }

  static async open(app: App): Promise<number> {
    const film = new Film(app);
    await film.widenScales();
    window.manyworldsFilm = film;
    return app.timeline.end;
  }

  // Ends of colours' scales grow with what has been seen: here all is seen first, so that a film has one scale.
  private async widenScales(): Promise<void> {
    const { worlds, sources } = this.app;
    if (!['speed', 'spin', 'contact'].includes(worlds.coloring.by)) return;
    for (const source of sources) {
      for (let frame = 0; frame < source.frames; ++frame) {
        await this.app.prepare(source.time(frame));
        worlds.read(source.time(frame));
        worlds.widenScales();
      }
    }
  }

  // The page at a time in s, in base64; `moment`: with that time on it.
  async frame(time: number, type: string, moment: boolean): Promise<string> {
    await this.app.prepare(time);
    const clock = document.getElementById('moment') as HTMLElement;
    clock.textContent = moment ? `${time.toFixed(2)} s` : '';
    clock.hidden = !moment;
    this.app.drawAt(time);
    this.pen.drawImage(this.app.stage.renderer.domElement, 0, 0);
    const words = ['head', 'moment'].map((id) => document.getElementById(id) as HTMLElement);
    for (const element of words) this.paintBox(element);
    this.app.panel.legend.paint(this.pen, this.canvas.width / window.innerWidth);
    for (const element of words) this.write(element);
    const blob = await this.canvas.convertToBlob({ type, quality: JPEG_QUALITY });
    return toBase64(blob);
  }

  // What lies behind the words of an element.
  private paintBox(element: HTMLElement): void {
    const { pen } = this;
    const { left, top, width, height } = element.getBoundingClientRect();
    if (width === 0) return;
    const style = getComputedStyle(element);
    const ratio = this.canvas.width / window.innerWidth;
    pen.save();
    pen.scale(ratio, ratio);
    pen.fillStyle = style.backgroundColor;
    pen.strokeStyle = style.borderTopColor;
    pen.lineWidth = 1;
    pen.beginPath();
    pen.roundRect(left + 0.5, top + 0.5, width - 1, height - 1, parseFloat(style.borderTopLeftRadius));
    pen.fill();
    pen.stroke();
    pen.restore();
  }

  // The words of an element, where and as the page shows them.
  private write(element: HTMLElement): void {
    const { pen } = this;
    const walker = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
    const ratio = this.canvas.width / window.innerWidth;
    pen.save();
    pen.scale(ratio, ratio);
    pen.textBaseline = 'alphabetic';
    for (let node = walker.nextNode(); node !== null; node = walker.nextNode()) {
      const style = getComputedStyle(node.parentElement as Element);
      pen.font = `${style.fontStyle} ${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
      pen.letterSpacing = style.letterSpacing === 'normal' ? '0px' : style.letterSpacing;
      pen.fillStyle = style.color;
      for (const word of (node.textContent ?? '').matchAll(/\S+\s?/g)) {
        const range = document.createRange();
        range.setStart(node, word.index);
        range.setEnd(node, word.index + word[0].trimEnd().length);
        const box = range.getBoundingClientRect();
        const { fontBoundingBoxAscent: up, fontBoundingBoxDescent: down } = pen.measureText(word[0]);
        if (box.width > 0) pen.fillText(word[0].trimEnd(), box.left, box.top + (box.height + up - down) / 2);
      }
    }
    pen.restore();
  }
}

async function toBase64(blob: Blob): Promise<string> {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => {
      const url = reader.result as string;
      resolve(url.slice(url.indexOf(',') + 1));
    };
    reader.onerror = () => reject(new Error('a frame cannot be read'));
    reader.readAsDataURL(blob);
  });
}
