// The program's figures as this page draws them: the parts of each together, the layers of a panel from
// the lowest to the uppermost.

const order = ['cells', 'span', 'band', 'reference', 'curve', 'points', 'note'];

function layersOf({ series, marks }) {
  const layers = [
    ...series.map(({ role, name, style, ...rest }) => ({ kind: role, words: name, ...rest, ...coloured(style) })),
    ...marks.map(({ role, style, lo, hi, cells, ...rest }) => ({ kind: role, ...rest, ...coloured(style),
      ...(role === 'span' ? { range: { lo, hi } } : {}),
      ...(cells ? { cells: cells.map(([x0, x1, y0, y1, value]) => ({ x: { lo: x0, hi: x1 }, y: { lo: y0, hi: y1 }, value })) } : {}) })),
  ];
  return layers.sort((a, b) => order.indexOf(a.kind) - order.indexOf(b.kind));
}

const coloured = (style) => (style ? { colour: style.colour, mark: style.mark, width: style.width,
  dash: (style.dash ?? '').split(' ').filter(Boolean).map(Number) } : {});

const axisOf = (axis) => ({ label: axis.label, logarithmic: axis.log, numbers: axis.numbers,
  ticks: axis.ticks, range: { lo: axis.lo, hi: axis.hi } });

function partOf(part) {
  if (part.type !== 'panel') return { ...part, kind: part.type };
  return { kind: 'panel', part: part.part, title: part.title, x: axisOf(part.x), y: axisOf(part.y), top: part.top ? axisOf(part.top) : null,
    remark: part.remark, key: part.key, layers: layersOf(part),
    scale: part.scale ? { label: part.scale.label, range: { lo: part.scale.lo, hi: part.scale.hi } } : null };
}

/** On paper the lowest panel alone numbers an axis that all share; here panels may stand side by side. */
function numbered(parts) {
  const panels = parts.filter(({ kind }) => kind === 'panel');
  for (let i = panels.length - 2; i >= 0; --i) {
    const [{ x }, below] = [panels[i], panels[i + 1].x];
    if (!x.numbers && x.range.lo === below.range.lo && x.range.hi === below.range.hi) panels[i].x = below;
  }
  return parts;
}

/** Figures of a list of parts, in which each figure begins with its part 0. */
export function figuresOf(parts) {
  const figures = [];
  for (const part of parts) {
    if (part.part === 0) figures.push({ kind: part.kind, heading: part.heading, description: part.description, toScale: part.to_scale, parts: [] });
    figures.at(-1).parts.push(partOf(part));
  }
  for (const figure of figures) {
    numbered(figure.parts);
    for (const part of figure.parts) {
      if (part.part !== 0 || !part.title.includes(figure.heading)) continue;
      figure.heading = part.title; // the figure's, which stands above its first panel
      part.title = '';
    }
  }
  return figures;
}
