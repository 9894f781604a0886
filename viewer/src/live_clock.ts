// The clock of a live page: its buttons command that of the program.
import { element } from './elements';
import type { LiveSource } from './live';
import type { Clock } from './timeline';

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 10, Infinity];

export class LiveClock implements Clock {
  time = 0;
  readonly end = 0;
  looping = false;

  constructor(private readonly source: LiveSource) {
    element('timeline').classList.add('live');
    for (const id of ['back', 'time', 'loop']) element(id).hidden = true;
    element('on').title = 'One step forward (→)';
    const select = element<HTMLSelectElement>('speed');
    select.replaceChildren(...SPEEDS.map((speed) =>
      new Option(speed === Infinity ? 'max' : `${speed}×`, String(speed), speed === 1, speed === 1)));
    select.onchange = () => {
      this.setSpeed(Number(select.value));
      select.blur();
    };
    element('play').onclick = () => this.play(!this.playing);
    element('on').onclick = () => this.step(1);
    if (!source.run.can.clock) for (const id of ['play', 'on', 'speed']) element(id).hidden = true;
  }

  get playing(): boolean {
    return !this.source.state.paused;
  }
  get speed(): number {
    return this.source.state.speed;
  }
  play(on: boolean): void {
    if (this.source.run.can.clock) this.source.link.send({ do: on ? 'play' : 'pause' });
  }
  step(steps: number): void {
    if (this.source.run.can.clock && steps > 0) this.source.link.send({ do: 'step', steps });
  }
  faster(by: number): void {
    const nearest = SPEEDS.findIndex((speed) => speed >= this.speed);
    this.setSpeed(SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, nearest + by))]);
  }
  private setSpeed(speed: number): void {
    if (this.source.run.can.clock) this.source.link.send({ do: 'speed', factor: speed === Infinity ? null : speed });
  }

  // There is no other moment than now.
  seek(): void {}
  jump(): void {}
  advance(): void {
    this.time = this.source.time(this.source.frames - 1);
  }

  tell(): void {
    const { paused, speed, reached, steps } = this.source.state;
    const button = element('play');
    button.textContent = paused ? '▶' : '❚❚';
    button.setAttribute('aria-label', paused ? 'Play' : 'Pause');
    const select = element<HTMLSelectElement>('speed');
    const known = SPEEDS.includes(speed) ? String(speed) : '';
    if (document.activeElement !== select && select.value !== known) select.value = known;
    const rate = paused ? 'paused' : this.source.run.can.clock ? `${reached.toPrecision(2)}×` : '';
    element('clock').textContent = `${this.time.toFixed(2)} s, step ${steps.toLocaleString('en')} ${rate}`;
  }
}
