// The panel's part about what is seen.
import type { Session } from '../session';
import type { ViewSettings } from '../view_settings';
import { nextStructureMode } from '../view_settings';
import { structureColour } from '../view/structure_colours';
import { button, make } from './dom';
import { pressed, row, say, type Section } from './panel';

const kAxes = ['X: left, right', 'Y: front, back', 'Z: head, feet'];
const kStructureWords = { behind: 'seen through all bone', exposed: 'where exposed', off: 'off' };

function slider(label: string, value: number, change: (value: number) => void): HTMLInputElement {
  const input = make('input');
  input.type = 'range';
  input.min = '0';
  input.max = '1';
  input.step = '0.005';
  input.value = String(value);
  input.setAttribute('aria-label', label);
  input.addEventListener('input', () => change(Number(input.value)));
  return input;
}

export function viewSection(session: Session, settings: ViewSettings, changed: () => void, firstView: () => void): Section {
  const toggle = (text: string, title: string, is_on: boolean, flip: () => void) =>
    pressed(button(text, title, () => {
      flip();
      changed();
    }), is_on);
  return {
    title: 'View',
    key: () => [settings.cuts.map((cut) => [cut.isOn, cut.isFlipped]), settings.isTransparent, settings.structures,
      settings.isEndoscope, settings.showsForce, settings.showsFigures, settings.showsDetails, settings.showsRemarks,
      session.scene?.epoch, session.scene?.materials.map((material) => material.isProtected)],
    content: () => {
      const parts: Node[] = [row(
        button('First view', 'R', firstView),
        toggle('Endoscope', 'E: the eye rides on the tool', settings.isEndoscope, () => (settings.isEndoscope = !settings.isEndoscope)),
        toggle('Force', 'F', settings.showsForce, () => (settings.showsForce = !settings.showsForce)),
        toggle('Figures', 'Shift+H', settings.showsFigures, () => (settings.showsFigures = !settings.showsFigures)),
        toggle('All figures', 'Shift+I', settings.showsDetails, () => (settings.showsDetails = !settings.showsDetails)),
        toggle('Notes', 'Shift+R', settings.showsRemarks, () => (settings.showsRemarks = !settings.showsRemarks)),
      ), say('Cut-planes')];
      settings.cuts.forEach((cut, i) => parts.push(row(
        toggle(kAxes[i], 'XYZ'[i], cut.isOn, () => {
          cut.isOn = !cut.isOn;
          settings.lastCut = i;
        }),
        ...(cut.isOn ? [
          slider(kAxes[i], cut.position, (value) => {
            cut.position = value;
            settings.lastCut = i;
            changed();
          }),
          toggle('⇄', 'cut away the other side', cut.isFlipped, () => (cut.isFlipped = !cut.isFlipped)),
        ] : []),
      )));
      parts.push(row(
        toggle('Transparent bone', 'T', settings.isTransparent, () => (settings.isTransparent = !settings.isTransparent)),
        ...(settings.isTransparent ? [slider('opacity', settings.opacity, (value) => {
          settings.opacity = value;
          changed();
        })] : []),
      ));
      const scene = session.scene, names = scene?.materials.flatMap((m, i) => (m.isProtected ? [[m.name, i + 1] as const] : [])) ?? [];
      if (scene && names.length > 0) {
        parts.push(row(make('span', { text: 'Protected structures' }), button(kStructureWords[settings.structures], 'Shift+T', () => {
          settings.structures = nextStructureMode(settings.structures);
          changed();
        })));
        for (const [name, id] of names) {
          const swatch = make('span', { name: 'swatch' });
          swatch.style.backgroundColor = `rgb(${structureColour(scene, id).map((part) => Math.round(255 * part)).join(' ')})`;
          parts.push(row(swatch, make('span', { text: name || `material ${id}` })));
        }
      }
      return parts;
    },
  };
}
