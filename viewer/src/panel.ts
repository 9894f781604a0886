// What is written beside the picture: how many worlds there are, and the chosen one.
import { speedOf, type FrameSource } from './data';
import { element } from './elements';
import { Legend } from './legend';
import type { Chosen } from './overlays';
import type { Worlds } from './worlds';

export class Panel {
  readonly legend = new Legend();
  private scrollTo = false; // the chosen body's line comes into view when it is next written

  // choose(row): a body of the chosen world is clicked.
  constructor(private readonly title: string, private readonly sources: FrameSource[],
    private readonly worlds: Worlds, private readonly choose: (row: number) => void) {}

  // Another world or body was chosen.
  chose(otherWorld: boolean): void {
    if (otherWorld) element('bodies').replaceChildren();
    this.scrollTo = true;
  }

  tellAbout(): void {
    const { cells } = this.worlds.layout;
    const lost = cells.filter((cell) => this.worlds.isLost(cell)).length;
    const about = element('about');
    const names = [...new Set(this.sources.flatMap((source) => source.run.kinds.map((kind) => kind.scene)))];
    about.replaceChildren(`${cells.length} ${cells.length === 1 ? 'world' : 'worlds'}${names.length > 0 && names.join() !== this.title ? ` of ${names.join(', ')}` : ''}, ${this.worlds.instances.toLocaleString('en')} shapes`);
    if (lost > 0) {
      const mark = document.createElement('span');
      mark.className = 'lost';
      mark.textContent = `, ${lost} lost`;
      about.append(mark);
    }
    const still = this.sources.some((source) => source.run.kinds.some((kind) => kind.rows > 0 && kind.turns === false));
    element('unturned').hidden = !still;
    about.title = this.sources.map((source) => source.run.origin).join('\n');
  }

  tellWorld(chosen: Chosen, following: boolean): void {
    const { cell: index, row: chosenRow } = chosen;
    const cell = this.worlds.layout.cells[index];
    const kind = this.worlds.kindOf(cell);
    const run = this.worlds.runOf(cell);
    const poses = this.worlds.posesOf(cell);
    const recording = this.sources.length > 1 ? `, recording ${cell.run + 1}` : '';
    element('world-name').textContent = `World ${kind.names[cell.world]}${recording}`;
    const status = poses.status[cell.world];
    const words = ['not finite, frozen', 'out of range, frozen', 'out of bounds', 'out of contact capacity', 'a joint broke', 'gained energy']
      .filter((_, bit) => (status >> bit) & 1);
    const followed = following ? ', followed' : '';
    element('world-about').textContent = `${kind.scene}: ${words.length > 0 ? words.join(', ') : 'ok'}${followed}`;
    const bodies = element('bodies');
    const moving = kind.bodies.map((body, b) => ({ body, b })).filter(({ body }) => body.row !== null);
    while (bodies.children.length < moving.length) {
      const line = document.createElement('tr');
      for (let c = 0; c < 6; ++c) line.append(document.createElement('td'));
      const row = moving[bodies.children.length].body.row as number;
      line.onclick = () => this.choose(row);
      bodies.append(line);
    }
    moving.forEach(({ body, b }, i) => {
      const line = bodies.children[i] as HTMLTableRowElement;
      const row = body.row as number;
      const item = cell.world * kind.rows + row;
      line.classList.toggle('chosen', row === chosenRow);
      const dot = document.createElement('span');
      dot.className = 'dot';
      dot.style.background = `rgb(${this.worlds.colorOf(index, row).join()})`;
      line.cells[0].replaceChildren(dot, body.name || `body ${b}`);
      line.cells[0].title = `${body.name || `body ${b}`}, ${body.mass.toPrecision(3)} kg`;
      const there = poses.there[item] !== 0;
      [poses.position[3 * item], poses.position[3 * item + 1], poses.position[3 * item + 2],
        speedOf(run, poses.speed[item]), speedOf(run, poses.spin[item])].forEach((x, c) => {
        const text = there ? x.toFixed(2) : '–';
        if (line.cells[c + 1].textContent !== text) line.cells[c + 1].textContent = text;
      });
      if (this.worlds.planar) line.cells[3].hidden = true;
    });
    if (this.scrollTo) bodies.querySelector('tr.chosen')?.scrollIntoView({ block: 'nearest' });
    this.scrollTo = false;
  }
}
