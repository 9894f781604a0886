// Where worlds stand: a grid for each run, side by side, or all runs in one place.
import type { Sides } from './clip';
import type { Kind, Run } from './data';

export interface Cell {
  run: number;
  kind: number;
  world: number; // of the kind
  x: number; // m, where the world's origin is
  y: number;
  ghost: boolean;
}

export interface Layout {
  cells: Cell[];
  low: number[]; // m, of one cell, about its origin
  high: number[];
  width: number; // m, from cell to cell
  depth: number;
  box: { low: number[]; high: number[] }; // of all
}

const GAP = 0.14; // of the larger side of a cell, between cells

// Near to what fills the window, and better so that the last row is full.
function columnsFor(count: number, wanted: number): number {
  let best = 1;
  let least = Infinity;
  for (let columns = 1; columns <= count; ++columns) {
    const empty = (columns - (count % columns)) % columns;
    const cost = Math.abs(Math.log(columns / wanted)) + 0.4 * (empty / columns);
    if (cost < least) {
      least = cost;
      best = columns;
    }
  }
  return best;
}

// Where what does not move is cut: within the gap between cells; null where a cell has no neighbour.
export function sidesOf(layout: Layout): Sides | null {
  if (!layout.cells.some((cell) => cell.x !== layout.cells[0].x || cell.y !== layout.cells[0].y)) return null;
  const more = [0.25 * (layout.width - (layout.high[0] - layout.low[0])), 0.25 * (layout.depth - (layout.high[1] - layout.low[1]))];
  return { low: [0, 1].map((c) => layout.low[c] - more[c]), high: [0, 1].map((c) => layout.high[c] + more[c]) };
}

export function makeLayout(runs: Run[], ghosts: boolean, aspect: number): Layout {
  const planar = runs[0].space === 'planar';
  const kinds: Kind[] = runs.flatMap((run) => run.kinds);
  const low = [0, 1, 2].map((c) => Math.min(...kinds.map((kind) => kind.low[c])));
  const high = [0, 1, 2].map((c) => Math.max(...kinds.map((kind) => kind.high[c])));
  const side = Math.max(high[0] - low[0], high[1] - low[1]);
  const width = high[0] - low[0] + GAP * side;
  const depth = high[1] - low[1] + GAP * side;
  const cells: Cell[] = [];
  const counts = runs.map((run) => run.kinds.reduce((sum, kind) => sum + kind.worlds, 0));
  const most = Math.max(...counts);
  const abreast = ghosts ? 1 : runs.length;
  // Seen from above a grid looks lower than it is deep.
  const look = planar ? 1 : 0.78;
  const columns = columnsFor(most, Math.sqrt((most * depth * look * aspect) / (abreast * width)));
  const between = runs.length > 1 && !ghosts ? 0.6 * width : 0;
  runs.forEach((run, r) => {
    let n = 0;
    const left = ghosts ? 0 : r * (columns * width + between);
    run.kinds.forEach((kind, k) => {
      for (let world = 0; world < kind.worlds; ++world, ++n) {
        cells.push({
          run: r, kind: k, world, ghost: ghosts && r > 0,
          x: left + (n % columns) * width, y: -Math.floor(n / columns) * depth,
        });
      }
    });
  });
  const xs = cells.map((cell) => cell.x);
  const ys = cells.map((cell) => cell.y);
  return {
    cells, low, high, width, depth,
    box: {
      low: [Math.min(...xs) + low[0], Math.min(...ys) + low[1], low[2]],
      high: [Math.max(...xs) + high[0], Math.max(...ys) + high[1], high[2]],
    },
  };
}
