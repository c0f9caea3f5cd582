// A line to write a note in.
import { tr } from '../shared/language';
import { button, make } from './dom';
import { row } from './panel';

export function askForNote(done: (note: string) => void): void {
  document.getElementById('note-form')?.remove();
  const input = make('input'), form = make('form');
  form.id = 'note-form';
  input.type = 'text';
  input.maxLength = 300;
  input.placeholder = tr('Note for everyone');
  input.setAttribute('aria-label', input.placeholder);
  const close = () => form.remove();
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    const note = input.value.trim();
    close();
    if (note) done(note);
  });
  form.addEventListener('keydown', (event) => {
    if (event.key === 'Escape') close();
  });
  const ok = button(tr('Show'), tr('to everyone'), () => undefined);
  ok.type = 'submit';
  form.append(row(input, ok, button(tr('Cancel'), 'Esc', close)));
  document.body.append(form);
  input.focus();
}
