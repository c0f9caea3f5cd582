// Figures, notices, alert and banner over the picture. Only what has changed is written into the document.
import { clockText } from '../shared/format';
import { tr } from '../shared/language';
import type { Session } from '../session';
import type { ViewSettings } from '../view_settings';
import { byId, make, setShown, setText } from './dom';
import { alertText, conditions, detailRows, faults, stateText, taskRows, titleOf, type Row, type Tone } from './words';

const kNoticeMs = 6000;
const kTaskMs = 12_000;

interface Notice {
  text: string;
  tone: Tone;
  until: number;
}

export class Hud {
  private notices: Notice[] = [];
  private readonly drawn = new Map<string, string>();
  private saidFaults = '';
  private saidTask = '';

  say(text: string, tone: Tone = 'plain', ms = kNoticeMs): void {
    this.notices = [...this.notices.filter((one) => one.text !== text), { text, tone, until: Date.now() + ms }].slice(-3);
  }

  update(session: Session, settings: ViewSettings, rate: number, nodes: number, triangles: number): void {
    const now = Date.now(), { events, structure } = session.alert(now);
    setShown(byId('figures'), settings.showsFigures);
    setText(byId('title'), session.scene?.title || session.status?.scene || 'bonemill');
    const state = stateText(session), clock = session.status ? `, ${clockText(session.status.sessionS)}` : '';
    const is_counting = session.isShown && session.status !== undefined;
    const waits = is_counting && session.status?.ticks === 0;
    setText(byId('state'), waits ? tr('waits for a device') : state.value + (is_counting ? clock : ''));
    byId('state').className = waits ? 'warning' : (state.tone ?? '');
    this.rows('rows', taskRows(session, events));
    setShown(byId('details'), settings.showsDetails);
    if (settings.showsDetails) this.rows('details', detailRows(session, rate, nodes, triangles));
    this.progress(session, nodes);
    this.alert(alertText(events, structure, session.scene));
    this.banner(session, now);
    this.sayNews(session);
    this.showNotices(session, now);
  }

  private rows(id: string, rows: Row[]): void {
    const text = JSON.stringify(rows);
    if (this.drawn.get(id) === text) return;
    this.drawn.set(id, text);
    byId(id).replaceChildren(...rows.flatMap((row) => [
      make('dt', { text: row.label }), make('dd', { text: row.value, name: row.tone ?? '' }),
    ]));
  }

  private progress(session: Session, nodes: number): void {
    const all = session.status?.nodeCount ?? 0;
    const is_loading = session.connection.state === 'open' && all > 0 && !session.hasBeenComplete;
    setShown(byId('progress'), is_loading);
    if (is_loading) byId('progress-bar').style.width = `${Math.round((100 * nodes) / all)}%`;
  }

  private alert(alert: { text: string; tone: Tone } | undefined): void {
    const element = byId('alert');
    setShown(element, alert !== undefined);
    if (!alert) return;
    setText(element, alert.text);
    element.className = alert.tone;
  }

  private banner(session: Session, now: number): void {
    const { connection } = session, element = byId('banner');
    setShown(element, connection.state === 'away' || connection.state === 'refused');
    if (connection.state === 'refused') setText(element, connection.reason ? tr(connection.reason) : tr('The gateway refuses this invitation.'));
    if (connection.state !== 'away') return;
    const away = clockText((now - connection.sinceMs) / 1000), next = Math.ceil((connection.nextTryMs - now) / 1000);
    const trying = next > 0 ? tr('trying again in {1} s', next) : tr('trying again');
    const picture = session.scene ? tr(' The picture is the last that came.') : '';
    setText(element, `${tr(connection.reason)} ${tr('Away for {1}, {2}.', away, trying)}${picture}`);
  }

  private sayNews(session: Session): void {
    const fault_text = session.status?.faultText ?? '';
    if (fault_text !== this.saidFaults) for (const fault of faults(fault_text)) this.say(fault.text, fault.tone);
    this.saidFaults = fault_text;
    const lesson = session.lesson, scene = lesson?.scenes.find((one) => one.id === lesson.sceneId);
    const task = scene?.task ?? '', key = `${lesson?.sceneId} ${lesson?.isRunning}`;
    if (task && key !== this.saidTask) this.say(task, 'plain', kTaskMs);
    this.saidTask = key;
  }

  private showNotices(session: Session, now: number): void {
    this.notices = this.notices.filter((one) => one.until > now);
    const changing = titleOf(session.lesson, session.lesson?.changingTo);
    const list: { text: string; tone: Tone }[] = [
      ...(changing ? [{ text: tr('Changing to {1} …', changing), tone: 'plain' as const }] : []),
      ...conditions(session), ...this.notices,
    ];
    const text = JSON.stringify(list.map(({ text, tone }) => [text, tone]));
    if (this.drawn.get('notices') === text) return;
    this.drawn.set('notices', text);
    byId('notices').replaceChildren(...list.map((one) => make('div', {}, make('p', { text: one.text, name: one.tone }))));
  }
}
