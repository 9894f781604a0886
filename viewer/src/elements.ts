// Elements of page.html.
export function element<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

// Over the picture until it is closed, where it can be; an empty text takes it away.
export function showMessage(text: string, closes: boolean): void {
  element('message').hidden = text === '';
  element('message-text').textContent = text;
  element('message-close').hidden = !closes;
  element('message-close').onclick = () => showMessage('', false);
}
