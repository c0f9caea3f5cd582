// The control panel: sections that are made anew only when what they show has changed, so that a finger on a slider or
// a name being typed is not disturbed.
import { byId, make } from './dom';

export interface Section {
  title: string;
  // Whatever the content depends on; nothing: the section is not shown.
  key(): unknown;
  content(): Node[];
}

export class Panel {
  private readonly keys: string[] = [];
  private readonly homes: HTMLElement[];

  constructor(private readonly sections: Section[]) {
    this.homes = sections.map(() => make('section'));
    byId('panel').append(...this.homes);
  }

  get isOpen(): boolean {
    return !byId('panel').hidden;
  }

  toggle(is_open = !this.isOpen): void {
    byId('panel').hidden = !is_open;
    this.update();
  }

  update(): void {
    if (!this.isOpen) return;
    this.sections.forEach((section, i) => {
      const value = section.key(), key = value === undefined ? '' : JSON.stringify(value);
      if (this.keys[i] === key) return;
      const home = this.homes[i];
      // What is being typed stays until the user leaves the field.
      const focus = document.activeElement;
      if (focus instanceof HTMLInputElement && focus.type === 'text' && home.contains(focus) && key !== '') return;
      this.keys[i] = key;
      home.hidden = key === '';
      home.replaceChildren(...(key === '' ? [] : [make('h2', { text: section.title }), ...section.content()]));
    });
  }
}

export function row(...children: Node[]): HTMLElement {
  return make('div', { name: 'row' }, ...children);
}

export function say(text: string, name = ''): HTMLElement {
  return make('p', { text, name: `say ${name}` });
}

export function pressed(element: HTMLButtonElement, is_pressed: boolean): HTMLButtonElement {
  element.setAttribute('aria-pressed', String(is_pressed));
  return element;
}

export function disabledFor(element: HTMLButtonElement, why: string): HTMLButtonElement {
  element.disabled = why !== '';
  if (why) element.title = why;
  return element;
}

export function choice(name: string, options: string[], chosen: number, why: string, choose: (i: number) => void): HTMLElement {
  const select = make('select');
  select.append(...options.map((text, i) => {
    const option = make('option', { text });
    option.value = String(i);
    return option;
  }));
  select.value = String(chosen);
  select.disabled = why !== '';
  select.setAttribute('aria-label', name);
  select.addEventListener('change', () => choose(Number(select.value)));
  return row(make('span', { text: name }), select);
}
