// Where in time the page is, and how fast it goes on.
import type { FrameSource } from './data';
import { element } from './elements';

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const SHORT = 10; // s; what is no longer plays again from its start
const HOLD_MS = 600; // how long its last frame stays before

export interface Clock {
  readonly end: number; // s
  time: number;
  readonly playing: boolean;
  readonly speed: number;
  looping: boolean;
  play(on: boolean): void;
  seek(time: number): void;
  step(frames: number): void;
  jump(seconds: number): void;
  faster(by: number): void;
  advance(now: number): void;
  tell(): void;
}

export class Timeline implements Clock {
  readonly end: number; // s
  time = 0;
  playing = false;
  private speedNow = 1;
  private lastTick = 0;
  private loops = false;
  private reachedEnd = 0; // ms, when

  constructor(private readonly sources: FrameSource[], private readonly changed: () => void) {
    this.end = Math.max(...sources.map((source) => source.time(source.frames - 1)));
    this.looping = this.end <= SHORT * (1 + 1e-9);
    element('loop').onclick = () => { this.looping = !this.looping; };
    element('play').onclick = () => this.play(!this.playing);
    element('back').onclick = () => this.step(-1);
    element('on').onclick = () => this.step(1);
    const slider = element<HTMLInputElement>('time');
    slider.max = String(this.end);
    slider.oninput = () => {
      this.play(false);
      this.seek(Number(slider.value));
    };
    const speed = element<HTMLSelectElement>('speed');
    speed.onchange = () => {
      this.speedNow = Number(speed.value);
      speed.blur();
    };
  }

  get speed(): number {
    return this.speedNow;
  }

  get looping(): boolean {
    return this.loops;
  }
  set looping(on: boolean) {
    this.loops = on;
    element('loop').setAttribute('aria-pressed', String(on));
  }

  play(on: boolean): void {
    if (this.end === 0) return;
    if (on && this.time >= this.end) this.seek(0);
    this.playing = on;
    const button = element('play');
    button.textContent = on ? '❚❚' : '▶';
    button.setAttribute('aria-label', on ? 'Pause' : 'Play');
    this.lastTick = performance.now();
  }

  seek(time: number): void {
    this.time = Math.max(0, Math.min(this.end, time));
    this.changed();
  }

  // To the next frame, or from between two to the one before.
  step(frames: number): void {
    this.play(false);
    const source = this.longest();
    let frame = 0;
    while (frame + 1 < source.frames && source.time(frame + 1) <= this.time + 1e-9) ++frame;
    const between = this.time - source.time(frame) > 1e-9;
    const to = frames < 0 && between ? frame : frame + frames;
    this.seek(source.time(Math.max(0, Math.min(source.frames - 1, to))));
  }

  jump(seconds: number): void {
    this.seek(this.time + seconds);
  }

  faster(by: number): void {
    const at = Math.max(0, Math.min(SPEEDS.length - 1, SPEEDS.indexOf(this.speedNow) + by));
    this.speedNow = SPEEDS[at];
    element<HTMLSelectElement>('speed').value = String(this.speedNow);
  }

  // now: ms, of the frame that is about to be drawn.
  advance(now: number): void {
    if (this.playing) {
      if (this.time < this.end) {
        this.seek(this.time + ((now - this.lastTick) / 1000) * this.speedNow);
        this.reachedEnd = now;
      } else if (this.looping && now - this.reachedEnd >= HOLD_MS) {
        this.seek(0);
      }
      if (this.time >= this.end && !this.looping) this.play(false);
    }
    this.lastTick = now;
  }

  tell(): void {
    element<HTMLInputElement>('time').value = String(this.time);
    element('clock').textContent = `${this.time.toFixed(2)} / ${this.end.toFixed(2)} s`;
  }

  private longest(): FrameSource {
    return this.sources.reduce((a, b) => (b.time(b.frames - 1) > a.time(a.frames - 1) ? b : a));
  }
}
