// Numbers and times as people read them, in the words of the native viewer (render_client/look/hud/figure_text.cpp).

export function figureText(value: number, decimals: number, unit: string): string {
  if (!Number.isFinite(value)) return '--';
  const text = value.toFixed(decimals);
  return (Number(text) === 0 && text.startsWith('-') ? text.slice(1) : text) + unit;
}

export function readableText(value: number, unit: string): string {
  const size = Math.abs(value);
  return figureText(value, size < 10 ? 2 : size < 1000 ? 1 : 0, unit);
}

// 0:00:07, 1:02:03
export function clockText(seconds: number): string {
  if (!(seconds >= 0)) return '--';
  const all = Math.floor(Math.min(seconds, 1e9));
  const two = (n: number) => String(n).padStart(2, '0');
  return `${Math.floor(all / 3600)}:${two(Math.floor(all / 60) % 60)}:${two(all % 60)}`;
}

export function shortened(text: string, most: number): string {
  const signs = [...text];
  return signs.length <= most ? text : signs.slice(0, most - 1).join('') + '…';
}
