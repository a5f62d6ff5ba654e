/* Lobes: a chart in SVG, redrawn at every change. */

const TALL = 340;
const PAPER = 640; // width on paper
const ROOM = { left: 58, right: 12, top: 10, bottom: 30 };
const hiddenModels = new Set();

const plane = () => lobes.planes[find("plane").value];
const channel = () => (find("channel") ? Number(find("channel").value) : 0);

function nearest(places, x) {
  let best = 0;
  places.forEach((place, i) => {
    if (Math.abs(place - x) < Math.abs(places[best] - x)) best = i;
  });
  return best;
}

function svg(name, attributes, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

function shortly(value) {
  if (value === null || value === undefined) return "\u2013";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return value.toExponential(2).replace("-", "\u2212");
  return String(Number(value.toPrecision(3))).replace("-", "\u2212");
}

function ticksOf(low, high, logarithmic) {
  const ticks = [];
  if (logarithmic) {
    const decades = Math.log10(high / low);
    for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; power += Math.ceil(decades / 6)) {
      for (const digit of decades < 2 ? [1, 2, 5] : [1]) ticks.push(digit * 10 ** power);
    }
  } else {
    const rough = high / 5;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((digit) => digit * power).find((size) => size >= rough);
    for (let i = 0; i * step <= high; i += 1) ticks.push(Number((i * step).toPrecision(6)));
  }
  return ticks.filter((tick) => tick >= low && tick <= high);
}

function rangeOf(values, measured, logarithmic) {
  const all = values.flat().filter((value) => value !== null && value > 0);
  const seen = measured.filter((value) => value !== null && value > 0);
  const top = Math.max(...all, ...seen);
  const highest = seen.length ? Math.max(...seen) : top;
  if (logarithmic) return [Math.min(...(seen.length ? seen : all)) / 2, top * 2];
  return [0, 1.15 * Math.min(top, 1.6 * highest)];
}

function drawLobes(width = find("chart").clientWidth) {
  const { angle, curve, mirror, label, models } = plane();
  const measured = plane().measured[channel()];
  const logarithmic = find("logarithmic").checked;
  const shown = names.filter((name) => !hiddenModels.has(name));
  const [low, high] = rangeOf(shown.map((name) => models[name][channel()]), measured, logarithmic);
  const wide = Math.max(width, 260);
  const x = (degrees) => ROOM.left + ((degrees + 90) / 180) * (wide - ROOM.left - ROOM.right);
  const share = (value) =>
    logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  const y = (value) => TALL - ROOM.bottom - share(value) * (TALL - ROOM.top - ROOM.bottom);
  const seen = (value) => value !== null && (!logarithmic || value > 0);

  const drawing = svg("svg", { viewBox: `0 0 ${wide} ${TALL}`, "aria-hidden": "true" });
  const clip = svg("clipPath", { id: "field" });
  clip.append(svg("rect", { x: ROOM.left, y: ROOM.top, width: wide - ROOM.left - ROOM.right, height: TALL - ROOM.top - ROOM.bottom }));
  drawing.append(clip);
  for (const tick of ticksOf(low, high, logarithmic)) {
    drawing.append(svg("line", { class: "axis", x1: ROOM.left, x2: wide - ROOM.right, y1: y(tick), y2: y(tick) }));
    drawing.append(svg("text", { x: ROOM.left - 8, y: y(tick) + 4, "text-anchor": "end" }, shortly(tick)));
  }
  for (let degrees = -90; degrees <= 90; degrees += 30) {
    drawing.append(svg("line", { class: "axis", x1: x(degrees), x2: x(degrees), y1: TALL - ROOM.bottom, y2: TALL - ROOM.bottom + 5 }));
    drawing.append(svg("text", { x: x(degrees), y: TALL - ROOM.bottom + 19, "text-anchor": "middle" }, `${degrees}°`.replace("-", "\u2212")));
  }
  find("x-label").innerHTML = label;
  drawing.append(svg("line", { class: "mirror", x1: x(mirror), x2: x(mirror), y1: ROOM.top, y2: TALL - ROOM.bottom }));
  const field = svg("g", { "clip-path": "url(#field)" });
  angle.forEach((degrees, i) => {
    if (seen(measured[i])) field.append(svg("circle", { cx: x(degrees), cy: y(measured[i]), r: angle.length > 120 ? 1.6 : 3.2 }));
  });
  for (const name of [...shown].reverse()) {
    let path = "";
    let joined = false;
    models[name][channel()].forEach((value, i) => {
      if (seen(value)) path += `${joined ? "L" : "M"}${x(curve[i]).toFixed(1)},${y(value).toFixed(1)}`;
      joined = seen(value);
    });
    field.append(svg("path", { d: path, class: `m${names.indexOf(name)}${name === chosen() ? " chosen" : ""}` }));
  }
  field.append(svg("line", { class: "cursor", y1: ROOM.top, y2: TALL - ROOM.bottom }));
  drawing.append(field);
  find("chart").replaceChildren(drawing);
  drawing.addEventListener("pointermove", (event) => {
    const box = drawing.getBoundingClientRect();
    const place = ((event.clientX - box.left) / box.width) * wide;
    const degrees = ((place - ROOM.left) / (wide - ROOM.left - ROOM.right)) * 180 - 90;
    find("cursor").value = Math.round(2 * degrees) / 2;
    readLobes();
  });
  drawing.place = x;
  readLobes();
}

function readLobes() {
  const { angle, curve, models } = plane();
  const degrees = Number(find("cursor").value);
  const drawing = find("chart").firstElementChild;
  const at = drawing.place(degrees);
  const cursor = drawing.querySelector(".cursor");
  cursor.setAttribute("x1", at);
  cursor.setAttribute("x2", at);
  const words = `${degrees}°`.replace("-", "\u2212");
  find("cursor-value").textContent = words;
  find("cursor").setAttribute("aria-valuetext", `${degrees} degrees`);
  const sample = nearest(angle, degrees);
  const near = Math.abs(angle[sample] - degrees) <= 2.5;
  const measured = near ? plane().measured[channel()][sample] : null;
  const put = (name, value, difference) => {
    const row = find("legend").querySelector(`[data-row="${CSS.escape(name)}"]`);
    row.classList.toggle("chosen", name === chosen());
    row.children[1].textContent = shortly(value);
    row.children[2].textContent = difference;
  };
  put("measured", measured, near ? `at ${shortly(angle[sample])}°` : "none near");
  for (const name of names) {
    const value = models[name][channel()][nearest(curve, near ? angle[sample] : degrees)];
    const share = measured && value !== null ? 100 * (value / measured - 1) : NaN;
    const digits = Math.abs(share) < 9.95 ? 1 : 0;
    const sign = share < 0 ? "\u2212" : "+";
    put(name, value, Number.isFinite(share) ? `${sign}${Math.abs(share).toFixed(digits)} %` : "\u2013");
  }
}

function prepareLobes() {
  const options = (id, words) => {
    if (!find(id)) return;
    words.forEach((word, i) => {
      const option = new Option("", i);
      option.innerHTML = word.replace(/<sub><i>([io])<\/i><\/sub>/g, (_, index) => ({ i: "\u1d62", o: "\u2092" })[index]);
      find(id).append(option);
    });
  };
  options("plane", lobes.planes.map((each) => each.title));
  if (find("channel")) lobes.channels.forEach((word, i) => find("channel").append(new Option(word, i)));
  find("plane").value = Math.floor((lobes.planes.length - 1) / 2);
  if (find("channel")) find("channel").value = Math.floor(lobes.channels.length / 2);
  find("cursor").value = Math.round(plane().mirror);
  for (const name of ["measured", ...names]) {
    const row = document.createElement("tr");
    row.dataset.row = name;
    const swatch = svg("svg", { viewBox: "0 0 35 14", "aria-hidden": "true" });
    swatch.append(
      name === "measured"
        ? svg("circle", { cx: 17, cy: 7, r: 4 })
        : svg("path", { d: "M0,7H35", class: `m${names.indexOf(name)}` })
    );
    const label = document.createElement("label");
    if (name !== "measured") {
      const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: true });
      box.addEventListener("change", () => {
        if (box.checked) hiddenModels.delete(name);
        else hiddenModels.add(name);
        drawLobes();
      });
      label.append(box);
    }
    label.append(swatch, name.replace(/([_+])/g, "$1\u200b"));
    const head = document.createElement("th");
    head.scope = "row";
    head.append(label);
    row.append(head, document.createElement("td"), document.createElement("td"));
    find("legend").append(row);
  }
  for (const id of ["plane", "channel", "logarithmic"]) {
    if (find(id)) find(id).addEventListener("change", () => drawLobes());
  }
  find("cursor").addEventListener("input", readLobes);
  new ResizeObserver(() => drawLobes()).observe(find("chart"));
  window.addEventListener("beforeprint", () => drawLobes(PAPER));
}
