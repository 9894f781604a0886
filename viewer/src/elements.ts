// Elements of page.html.
export function element<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}
