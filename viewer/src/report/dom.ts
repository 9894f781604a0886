// Elements, made from what is in them. All text is text: nothing of a report is read as HTML.

export type Child = Node | string | null | Child[];

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Record<string, string> = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
  const out = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) out.setAttribute(name, value);
  add(out, children);
  return out;
}

export function add(parent: Node, children: Child[]): void {
  for (const child of children) {
    if (Array.isArray(child)) add(parent, child);
    else if (child !== null) parent.appendChild(typeof child === 'string' ? document.createTextNode(child) : child);
  }
}

// In the order in which keys first come.
export function grouped<T>(items: T[], key: (item: T) => string): Map<string, T[]> {
  const out = new Map<string, T[]>();
  for (const item of items) {
    const at = out.get(key(item));
    if (at) at.push(item);
    else out.set(key(item), [item]);
  }
  return out;
}

export const distinct = <T>(items: T[]): T[] => [...new Set(items)];

export interface Cell {
  text: string;
  mark?: boolean; // in the colour of what passed, or of what failed
  note?: string; // below, small
  title?: string; // told where one points at it
  left?: boolean;
}

// Scrolls in itself where it is too wide for the page. The first column names the row.
export function table(head: string[], rows: (string | Cell)[][], classes = ''): HTMLElement {
  const cell = (content: string | Cell, index: number): HTMLElement => {
    const { text, mark, note, title, left }: Cell = typeof content === 'string' ? { text: content } : content;
    const names = [mark === undefined ? '' : mark ? 'pass' : 'fail', left ? 'left' : ''].join(' ').trim();
    const out = make(index === 0 ? 'th' : 'td', names ? { class: names } : {}, text, note ? make('small', {}, note) : null);
    if (index === 0) out.setAttribute('scope', 'row');
    if (title) out.title = title;
    return out;
  };
  const isLeft = (index: number): boolean => {
    const first = rows[0]?.[index];
    return typeof first === 'object' && first.left === true;
  };
  return make('div', { class: `table ${classes}`.trim(), tabindex: '0', role: 'region', 'aria-label': head[0] },
    make('table', {},
      make('thead', {}, make('tr', {}, head.map((text, i) => make('th', { scope: 'col', ...(isLeft(i) ? { class: 'left' } : {}) }, text)))),
      make('tbody', {}, rows.map((row) => make('tr', {}, row.map(cell))))));
}
