// Small makers of elements. Texts of others become text and nothing else.

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, props: { text?: string; name?: string; title?: string } = {}, ...children: Node[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  if (props.text !== undefined) element.textContent = props.text;
  if (props.name) element.className = props.name;
  if (props.title) element.title = props.title;
  element.append(...children);
  return element;
}

export function button(text: string, title: string, act: () => void): HTMLButtonElement {
  const element = make('button', { text, title });
  element.type = 'button';
  element.addEventListener('click', act);
  return element;
}

export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

export function setShown(element: HTMLElement, is_shown: boolean): void {
  if (element.hidden === is_shown) element.hidden = !is_shown;
}
