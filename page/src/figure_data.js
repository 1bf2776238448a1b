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
  return { kind: 'panel', title: part.title, x: axisOf(part.x), y: axisOf(part.y), top: part.top ? axisOf(part.top) : null,
    remark: part.remark, key: part.key, layers: layersOf(part),
    scale: part.scale ? { label: part.scale.label, range: { lo: part.scale.lo, hi: part.scale.hi } } : null };
}

/** Figures of a list of parts, in which each figure begins with its part 0. */
export function figuresOf(parts) {
  const figures = [];
  for (const part of parts) {
    if (part.part === 0) figures.push({ kind: part.kind, heading: part.heading, description: part.description, parts: [] });
    figures.at(-1).parts.push(partOf(part));
  }
  return figures;
}
