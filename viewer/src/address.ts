// What the address of a page asks for: page.html#time=2.5&world=3&color=speed&theme=dark.
import { element } from './elements';
import type { App } from './main';

// Does it, apart from the time. What of it there is not, for people; or empty.
export function obeyAddress(app: App, wanted: URLSearchParams): string {
  let refused = '';
  const theme = wanted.get('theme');
  if (theme === 'dark' || theme === 'light') app.setTheme(theme);
  const color = wanted.get('color');
  const choice = element<HTMLSelectElement>('color');
  const colors = [...choice.options].map((option) => option.value);
  if (color !== null && colors.includes(color)) {
    choice.value = color;
    choice.dispatchEvent(new Event('change'));
  } else if (color !== null) {
    refused = `there is no colour by '${color}', only by ${colors.join(', ')}`;
  }
  const world = wanted.get('world');
  const cell = Number(world);
  const cells = app.worlds.layout.cells.length;
  if (world !== null && world !== '' && Number.isInteger(cell) && cell >= 0 && cell < cells) {
    app.choose(cell, -1);
    app.showCell(cell);
  } else if (world !== null) {
    refused = `there is no world ${world}, only 0 to ${cells - 1}`;
  }
  return refused;
}
