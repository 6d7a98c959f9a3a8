// The controls of a case: sliders, fields and selects that read and change its table.
"use strict";

{
  const make = (name, attributes = {}, ...inside) => {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
      if (key === "text") element.textContent = value;
      else if (value === true) element.setAttribute(key, "");
      else if (value !== false && value !== undefined && value !== null) element.setAttribute(key, value);
    }
    element.append(...inside);
    return element;
  };
  vibroimpact.make = make;

  // The table of a case at a path, such as ["plate", "size", 2].
  const at = (table, path) => path.reduce((part, key) => (part === undefined || part === null ? undefined : part[key]), table);
  const put = (table, path, value) => {
    let part = table;
    for (const [index, key] of path.slice(0, -1).entries()) {
      if (typeof part[key] !== "object" || part[key] === null) part[key] = typeof path[index + 1] === "number" ? [] : {};
      part = part[key];
    }
    const last = path[path.length - 1];
    if (value === undefined) delete part[last]; else part[last] = value;
  };
  const digits = (value) => { const size = Math.abs(value); return size >= 1e6 || (size < 1e-3 && size > 0) ? Number(value.toPrecision(5)).toExponential().replace("e+", "e") : String(Number(value.toPrecision(6))); };
  // The unit of a stiffness, told for Hertz's exponent, with that of the case.
  const unitWith = (exponent, unit) => (typeof exponent === "number" ? unit.replace("¹·⁵", exponent === 1 ? "" : Array.from(String(exponent), (letter) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[letter] || "·").join("")) : unit);
  const words = (name) => name[0].toUpperCase() + name.slice(1).replaceAll("_", " ");

  // A number of a field as the table has it: in SI as a number, else with its unit.
  const inUnit = (value, unit, size) => (size === 1 ? Number(value) : `${value} ${unit}`);
  const labelled = (path, id, label, meaning, ...inside) => make("div", { class: "row", "data-key": path.join(".") }, make("label", { for: id, text: label, title: meaning }), ...inside);

  // A slider with a field, of a number at a path: `size` is that of its unit in SI, `low` and `high` the ends of the slider in this unit;
  // `shown` is its path in the resolved case, and `otherwise` what it is where the case does not give it.
  const slider = (controls, { path, shown = path, label, unit = "", size = 1, low, high, log = false, whole = false, meaning = "", otherwise }) => {
    const key = path.join(".");
    const id = `c-${key.replaceAll(".", "-")}`;
    const toPlace = (value) => (log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
    const fromPlace = (place) => { const value = log ? low * (high / low) ** place : low + place * (high - low); return Math.min(Math.max(whole ? Math.round(value) : Number(value.toPrecision(3)), low), high); };
    const within = (place) => Math.min(Math.max(place, 0), 1) || 0;
    const range = make("input", { type: "range", id: `${id}-slider`, min: 0, max: 1, step: "any", "aria-label": `${label}, slider` });
    const field = make("input", { type: "number", id, step: "any", title: meaning });
    const row = labelled(path, id, label, meaning, range, field, make("span", { class: "unit", text: unit }));
    const tell = (value) => range.setAttribute("aria-valuetext", `${digits(value)} ${unit}`.trim());
    const set = (value, settled) => {
      controls.change((table) => {
        // a list of numbers, or a material of the library, is changed as a whole: its other values stay as they are
        const whole = path.slice(0, -1), now = at(table, whole), resolved = at(controls.resolved, whole);
        if (whole.length > 1 && (typeof now !== "object" || now === null) && resolved) put(table, whole, ownCopy(resolved));
        if (path[1] === "modes") delete at(table, whole).max_frequency;
        put(table, path, inUnit(value, unit, size));
      }, settled);
    };
    range.addEventListener("input", () => { const value = fromPlace(Number(range.value)); field.value = digits(value); tell(value); set(value, false); });
    range.addEventListener("change", () => set(fromPlace(Number(range.value)), true));
    range.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -0.01, ArrowDown: -0.01, ArrowRight: 0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      const now = fromPlace(Number(range.value)), next = within(Number(range.value) + step);
      range.value = String(whole && fromPlace(next) === now ? within(toPlace(now + Math.sign(step))) : next);
      range.dispatchEvent(new Event("input"));
      range.dispatchEvent(new Event("change"));
    });
    let typing = false;
    field.addEventListener("input", () => { typing = true; });
    field.addEventListener("change", () => {
      typing = false;
      if (field.value === "") row.show(); else set(Number(field.value), true);
    });
    row.show = () => {
      const value = at(controls.resolved, shown) ?? otherwise;
      const number = Array.isArray(value) ? value[0] : value;
      if (typeof number !== "number") return;
      if (document.activeElement !== range || !controls.moving) range.value = String(within(toPlace(number / size)));
      if (!typing) field.value = digits(number / size);
      tell(number / size);
    };
    return row;
  };
  // A field of the numbers of a list at a path, such as one for each impact, in a unit.
  const listField = (controls, { path, label, unit = "", size = 1, meaning = "" }) => {
    const id = `c-${path.join("-")}`;
    const field = make("input", { type: "text", id, class: "list", title: meaning });
    const row = labelled(path, id, label, meaning, field, make("span", { class: "unit", text: unit }));
    const read = (words) => (words === "" || Number.isNaN(Number(words)) ? words : inUnit(words, unit, size));
    field.addEventListener("change", () => controls.change((table) => {
      const values = field.value.split(",").map((words) => read(words.trim()));
      put(table, path, values.length > 1 ? values : values[0]);
    }, true));
    row.show = () => {
      const value = at(controls.resolved, path);
      if (Array.isArray(value) && document.activeElement !== field) field.value = value.map((one) => digits(one / size)).join(", ");
    };
    return row;
  };
  // A field of a number that the case does not give; where nothing is given, `hint` stands in it.
  const openField = (controls, { path, label, unit = "", size = 1, hint = "", meaning = "" }) => {
    const id = `c-${path.join("-")}`;
    const field = make("input", { type: "number", id, step: "any", class: "list", placeholder: hint, title: meaning });
    const row = labelled(path, id, label, meaning, field, make("span", { class: "unit", text: unit }));
    field.addEventListener("change", () => controls.change((table) => put(table, path, field.value === "" ? undefined : inUnit(field.value, unit, size)), true));
    return row;
  };
  // A copy of a list, or of a material, which has no name of the library any more.
  const ownCopy = (part) => {
    if (ArrayBuffer.isView(part) || Array.isArray(part)) return Array.from(part);
    const { name, ...kept } = part;
    return kept;
  };

  // A select at a path; `options` are pairs of value and label, or a function of the resolved case that returns them.
  const choice = (controls, { path, label, options, chosen, choose }) => {
    const key = path.join(".");
    const id = `c-${key.replaceAll(".", "-")}-choice`;
    const select = make("select", { id });
    const row = make("div", { class: "row", "data-key": key }, make("label", { for: id, text: label }), select);
    select.addEventListener("change", () => controls.change((table) => choose(table, select.value), true, true));
    row.show = () => {
      const now = chosen(controls.table, controls.resolved);
      const list = [...options];
      if (!list.some(([value]) => value === now)) list.push([now, now === "given" ? "as the case gives it" : String(now)]);
      select.replaceChildren(...list.map(([value, text]) => make("option", { value, text, selected: value === now })));
      select.value = now;
    };
    return row;
  };

  const textField = (controls, { path, label }) => {
    const id = `c-${path.join("-")}`;
    const field = make("input", { type: "text", id, class: "all", maxlength: 200 });
    const row = make("div", { class: "row", "data-key": path.join(".") }, make("label", { for: id, text: label }), field);
    field.addEventListener("change", () => controls.change((table) => put(table, path, field.value), true));
    row.show = () => { if (document.activeElement !== field) field.value = at(controls.table, path) ?? ""; };
    return row;
  };

  const group = (name, ...rows) => {
    const rowsThere = rows.filter(Boolean);
    return make("fieldset", {}, make("legend", { text: name }), ...rowsThere);
  };

  const material = (controls, body) => {
    const path = [body, "material"];
    const rigid = body === "plate" && controls.resolved.plate.model !== "elastic" ? [["rigid", "rigid"]] : [];
    const resolved = at(controls.resolved, path);
    const rows = [choice(controls, {
      path, label: "Material", options: [...controls.offer.materials.map((name) => [name, name]), ...rigid],
      chosen: (table) => (typeof at(table, path) === "string" ? at(table, path) : "given"),
      choose: (table, value) => { if (value !== "given") put(table, path, value); },
    })];
    if (resolved === "rigid") return rows;
    const property = (name, label, unit, size, low, high, log) => {
      const row = slider(controls, { path: [...path, name], label, unit, size, low, high, log });
      return row;
    };
    return [...rows, property("density", "Density", "kg/m³", 1, 500, 12000, true), property("youngs_modulus", "Modulus", "GPa", 1e9, 0.01, 700, true), property("poissons_ratio", "Poisson's ratio", "", 1, 0, 0.49)];
  };

  const damping = (controls, body) => {
    const path = [body, "damping"];
    const rows = [choice(controls, {
      path, label: "Damping", options: [["ratio", "one ratio"], ["adams-default", "Adams' default"]],
      chosen: (table) => { const now = at(table, path); return now === undefined || typeof now === "number" ? "ratio" : typeof now === "string" ? now : "given"; },
      choose: (table, value) => { if (value === "ratio") put(table, path, 0.01); else if (value !== "given") put(table, path, value); },
    })];
    if (typeof at(controls.resolved, path) === "number") rows.push(slider(controls, { path, label: "Ratio", low: 0.0005, high: 0.3, log: true }));
    return rows;
  };

  // Mass and moment of inertia of a ball that is not solid; an elastic one is.
  const ball = (controls) => {
    const { sphere, contact } = controls.resolved, mass = { path: ["sphere", "mass"], label: "Mass", unit: "g", size: 1e-3 };
    if (sphere.model === "elastic") return [];
    const rows = [sphere.mass === undefined ? openField(controls, { ...mass, hint: "of a solid one" }) : slider(controls, { ...mass, low: 0.1, high: 10000, log: true })];
    const path = ["sphere", "inertia"];
    if (contact.friction || sphere.inertia !== undefined) rows.push(choice(controls, {
      path, label: "Inertia", options: [["solid", "of a solid ball"], ["hollow", "of a thin shell"]],
      chosen: (table) => at(table, path) ?? "solid",
      choose: (table, value) => put(table, path, value === "solid" ? undefined : value),
    }));
    return rows;
  };

  const bodyRows = (controls, body) => {
    const resolved = controls.resolved[body];
    const model = choice(controls, {
      path: [body, "model"], label: "Model", options: [["rigid", "rigid"], ["elastic", "elastic"]],
      chosen: (table) => at(table, [body, "model"]) ?? "rigid",
      choose: (table, value) => setModel(table, body, value, controls),
    });
    if (resolved.model !== "elastic") return [model];
    return [model, slider(controls, { path: [body, "modes"], label: "Modes", low: 1, high: 300, whole: true, log: true }), ...damping(controls, body)];
  };

  // What only an elastic body has goes with its model, as what only a rigid one has, and a plate that is to vibrate needs a size.
  const RIGID = { sphere: ["mass", "inertia"], plate: [] };
  const setModel = (table, body, value, controls) => {
    const section = table[body];
    section.model = value;
    controls.kept[body] = controls.kept[body] || {};
    for (const key of controls.offer.elastic_keys) {
      if (value === "rigid" && key in section && !(key === "supports" && section.radius !== undefined)) { controls.kept[body][key] = section[key]; delete section[key]; }
      if (value === "elastic" && key in controls.kept[body] && !(key in section)) section[key] = controls.kept[body][key];
    }
    for (const key of RIGID[body]) {
      if (value === "elastic" && key in section) { controls.kept[body][key] = section[key]; delete section[key]; }
      if (value === "rigid" && key in controls.kept[body] && !(key in section)) section[key] = controls.kept[body][key];
    }
    if (body === "plate" && value === "rigid") {
      controls.kept.sensors = table.sensors;
      delete table.sensors;
    } else if (body === "plate") {
      if (!section.size && section.radius === undefined) section.size = ["520 mm", "420 mm", "8 mm"];
      if (controls.kept.sensors && !table.sensors) table.sensors = controls.kept.sensors;
      if (section.supports === undefined) section.supports = "simply-supported";
    }
    if (value === "elastic") {
      if (section.damping === undefined) section.damping = 0.01;
      if (section.modes === undefined && section.max_frequency === undefined) section.modes = body === "plate" ? 60 : 20;
    }
    const deforms = vibrates(table), rubs = table.contact.friction;
    if (deforms && rubs && isImpulsive(controls, rubs.law)) table.contact.friction = { law: "mdr", coefficient: rubs.coefficient };
    const local = ["local_compliance", "finite_sphere", "local_stiffness", "local_damping", "measured"];
    controls.kept.contact = controls.kept.contact || {};
    for (const key of local) {
      if (!deforms && key in table.contact) { controls.kept.contact[key] = table.contact[key]; delete table.contact[key]; }
      if (deforms && key in controls.kept.contact && !(key in table.contact)) table.contact[key] = controls.kept.contact[key];
    }
  };

  const supports = (controls) => {
    const path = ["plate", "supports"];
    const now = at(controls.table, path);
    const rows = [choice(controls, {
      path, label: "Held", options: [["free", "free"], ["clamped", "clamped edges"], ["simply-supported", "simply supported edges"], ["patches", "on four patches"]],
      chosen: (table) => { const given = at(table, path); return typeof given === "string" ? given : given && given.type === "patches" ? "patches" : given === undefined ? "free" : "given"; },
      choose: (table, value) => {
        if (value === "given") return;
        const { drop, sphere, plate } = controls.resolved, size = plate.size || [0.52, 0.42, 0.008];
        if (value === "free" && drop.gravity) {
          // a free plate is hit in free space, at the speed of the drop
          controls.kept.drop = table.drop;
          const { height, ...others } = table.drop, speed = drop.speed ?? Math.sqrt(2 * drop.gravity * Math.max(drop.height - sphere.radius, 0));
          table.drop = { ...others, speed: Number(speed.toPrecision(6)), gravity: 0 };
          delete table.plate.motion;
        } else if (value !== "free" && controls.kept.drop) {
          table.drop = controls.kept.drop;
          delete controls.kept.drop;
        }
        if (at(table, [...path, "type"]) === "patches") controls.kept.patches = at(table, path);
        put(table, path, value === "patches" ? controls.kept.patches || { type: "patches", spacing: [`${digits(880 * size[0])} mm`, `${digits(860 * size[1])} mm`], radius: `${digits(Math.min(20, 45 * size[0], 45 * size[1]))} mm` } : value);
      },
    })];
    if (now && now.type === "patches") {
      // patches lie on the plate, and not on each other; the resolved case lists supports
      const sides = at(controls.resolved, ["plate", "size"]), { spacing, radius } = at(controls.resolved, [...path, 0]);
      const most = (side) => Math.max(990 * (sides[side] - 2.3 * radius), 2500 * radius), widest = 990 * Math.min(...[0, 1].flatMap((side) => [(sides[side] - spacing[side]) / 2.3, spacing[side] / 2.4]));
      const length = (inner, label, low, high) => slider(controls, { path: [...path, ...inner], shown: [...path, 0, ...inner], label, unit: "mm", size: 1e-3, low, high });
      rows.push(length(["spacing", 0], "Spacing x", 2400 * radius, most(0)), length(["spacing", 1], "Spacing y", 2400 * radius, most(1)), length(["radius"], "Radius", 1, Math.max(widest, 2)));
    }
    return rows;
  };

  // Multiples of the units of a law's parameters that numbers of everyday size have.
  const MULTIPLES = { Pa: (name) => (name.includes("modulus") ? ["GPa", 1e9] : ["MPa", 1e6]), m: () => ["mm", 1e-3], s: () => ["µs", 1e-6] };

  // The law of the table, which the resolved case does not have yet where a parameter is missing.
  const law = (controls) => {
    const name = at(controls.table, ["contact", "law"]), found = controls.offer.laws[name];
    const contact = controls.resolved.contact.law === name ? controls.resolved.contact : controls.table.contact;
    const rows = [choice(controls, {
      path: ["contact", "law"], label: "Law", options: Object.keys(controls.offer.laws).map((one) => [one, one]),
      chosen: (table) => at(table, ["contact", "law"]),
      choose: (table, value) => {
        const old = new Set((controls.offer.laws[table.contact.law] || { parameters: [] }).parameters.map((one) => one.name));
        const kept = Object.fromEntries(Object.entries(table.contact).filter(([key]) => !old.has(key)));
        for (const one of controls.offer.laws[value].parameters) {
          if (old.has(one.name) && one.name in table.contact && one.name !== "stiffness") kept[one.name] = table.contact[one.name];
          const example = /such as ([-+.\deE]+)/.exec(one.default);
          if (example && !(one.name in kept)) kept[one.name] = Number(example[1]);
        }
        table.contact = { ...kept, law: value };
      },
    })];
    if (!found) return rows;
    rows.push(make("p", { class: "note", text: found.equation }));
    for (const one of found.parameters) {
      const value = contact[one.name];
      const [unit, size] = MULTIPLES[one.unit] ? MULTIPLES[one.unit](one.name) : [unitWith(contact.exponent, one.unit), 1];
      const described = { path: ["contact", one.name], label: words(one.name), unit, size, meaning: `${one.meaning} Allowed: ${one.allowed || "any number"}.` };
      if (Array.isArray(value)) { rows.push(listField(controls, described)); continue; }
      // a function of the approach speed is kept as the case has it
      if (value && typeof value === "object") { rows.push(make("p", { class: "note", text: `${words(one.name)}: a function of the approach speed, as the case gives it.` })); continue; }
      if (typeof value !== "number") { rows.push(openField(controls, { ...described, hint: one.default })); continue; }
      const number = value / size, part = /at most 1\b/.test(one.allowed) || (one.name === "restitution");
      const ends = part ? { low: 0.01, high: 1 } : number > 0 ? { low: number / 30, high: number * 30, log: true } : { low: 0, high: 1 };
      if (one.name === "exponent") Object.assign(ends, { low: 1, high: 3, log: false });
      if (one.name === "meyer_index") Object.assign(ends, { low: 2, high: 3, log: false });
      // ends that follow the value would run away from the pointer: those of the first look stay
      const key = `${name} ${one.name}`;
      controls.ends[key] = controls.ends[key] || ends;
      rows.push(slider(controls, { ...described, ...controls.ends[key] }));
    }
    return rows;
  };

  const sensors = (controls) => {
    const list = controls.table.sensors || [];
    const rows = list.flatMap((sensor, index) => {
      const remove = make("button", { type: "button", text: "Remove", "aria-label": `Remove sensor ${sensor.name}` });
      remove.addEventListener("click", () => controls.change((table) => { table.sensors.splice(index, 1); if (!table.sensors.length) delete table.sensors; }, true, true));
      const half = (side) => 500 * ((at(controls.resolved, ["plate", "size", side]) || 0.5));
      const place = Array.isArray(sensor.position)
        ? [["x", 0], ["y", 1]].map(([label, side]) => slider(controls, { path: ["sensors", index, "position", side], label, unit: "mm", size: 1e-3, low: -half(side), high: half(side) }))
        : [];
      const motions = ["displacement", "velocity", "acceleration"];
      // an instrument that puts out another quantity is kept as the case has it
      const quantity = motions.includes(at(controls.resolved, ["sensors", index, "quantity"]) ?? "acceleration") ? [choice(controls, {
        path: ["sensors", index, "quantity"], label: "Reads", options: motions.map((name) => [name, name]),
        chosen: (table) => at(table, ["sensors", index, "quantity"]) ?? "acceleration",
        choose: (table, value) => { put(table, ["sensors", index, "quantity"], value); if (value !== "acceleration") { delete table.sensors[index].instrument; delete table.sensors[index].accelerometer; } },
      })] : [];
      const part = make("div", { class: "sensor", role: "group", "aria-label": `Sensor ${sensor.name}` }, textField(controls, { path: ["sensors", index, "name"], label: "Name" }), ...place, ...quantity, remove);
      return [part];
    });
    const add = make("button", { type: "button", text: "Add a sensor" });
    add.addEventListener("click", () => controls.change((table) => {
      table.sensors = table.sensors || [];
      let number = table.sensors.length + 1;
      while (table.sensors.some((sensor) => sensor.name === `a${number}`)) number += 1;
      table.sensors.push({ name: `a${number}`, position: ["50 mm", "50 mm"], quantity: "acceleration" });
    }, true, true));
    return [...rows, add];
  };

  // Whether the sphere may fall obliquely: on a flat plate whose sides are known.
  const isFlat = ({ plate }) => plate.radius === undefined && plate.mesh?.file === undefined;

  // Friction laws without tangential compliance, which friction on bodies that deform needs.
  const isImpulsive = (controls, law) => controls.offer.impulsive_friction.includes(law);
  const vibrates = ({ sphere, plate }) => [sphere, plate].some((body) => body.model === "elastic");

  const friction = (controls) => {
    const path = ["contact", "friction"], now = at(controls.resolved, path);
    if (!isFlat(controls.resolved)) return [];
    const laws = controls.offer.friction.filter((name) => !(vibrates(controls.resolved) || controls.resolved.plate.motion) || !isImpulsive(controls, name));
    const rows = [choice(controls, {
      path: [...path, "law"], label: "Friction", options: ["none", ...laws].map((name) => [name, name]),
      chosen: (table) => at(table, [...path, "law"]) ?? "none",
      choose: (table, value) => { if (value === "none") delete table.contact.friction; else table.contact.friction = { law: value, coefficient: now?.coefficient ?? controls.offer.friction_coefficient }; },
    })];
    if (now) rows.push(slider(controls, { path: [...path, "coefficient"], label: "Coefficient", low: 0, high: 1 }));
    return rows;
  };

  // The motion of the supports of a plate, where they hold it.
  const motion = (controls) => {
    const path = ["plate", "motion"];
    if (!isFlat(controls.resolved) || controls.resolved.plate.supports === "free") return [];
    const rows = [choice(controls, {
      path, label: "Motion", options: [["rest", "at rest"], ["shaken", "shaken"]],
      chosen: (table) => (table.plate.motion === undefined ? "rest" : "shaken"),
      choose: (table, value) => {
        if (value === "rest") { delete table.plate.motion; return; }
        table.plate.motion = { amplitude: "1 mm", frequency: "25 Hz" };
        const rubs = table.contact.friction;
        if (rubs && isImpulsive(controls, rubs.law)) table.contact.friction = { law: "mdr", coefficient: rubs.coefficient };
      },
    })];
    if (!controls.resolved.plate.motion) return rows;
    const directions = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
    return [
      ...rows,
      slider(controls, { path: [...path, "amplitude"], label: "Amplitude", unit: "mm", size: 1e-3, low: 0.01, high: 20, log: true }),
      slider(controls, { path: [...path, "frequency"], label: "Frequency", unit: "Hz", low: 1, high: 500, log: true }),
      slider(controls, { path: [...path, "phase"], label: "Phase", unit: "deg", size: Math.PI / 180, low: -180, high: 180, otherwise: 0 }),
      choice(controls, {
        path: [...path, "direction"], label: "Direction", options: [["z", "along the normal"], ["x", "along x"], ["y", "along y"]],
        chosen: (table, resolved) => Object.keys(directions).find((axis) => String(directions[axis]) === String(Array.from(resolved.plate.motion?.direction ?? []))) ?? "given",
        choose: (table, value) => { if (value !== "given") table.plate.motion.direction = directions[value]; },
      }),
    ];
  };

  const drop = (controls) => {
    const bySpeed = at(controls.resolved, ["drop", "speed"]) !== undefined && at(controls.resolved, ["drop", "height"]) === undefined;
    const how = choice(controls, {
      path: ["drop", "from"], label: "Given by", options: [["height", "height"], ["speed", "speed at first touch"]],
      chosen: (table) => ("speed" in table.drop ? "speed" : "height"),
      choose: (table, value) => { for (const key of ["speed", "height", "angle", "velocity"]) delete table.drop[key]; table.drop[value] = value === "speed" ? 5 : 2; },
    });
    const gravity = slider(controls, { path: ["drop", "gravity"], label: "Gravity", unit: "m/s²", low: 0.5, high: 25 });
    const air = choice(controls, {
      path: ["drop", "air"], label: "Air", options: [["none", "none"], ["air", "at 20 °C and sea level"]],
      chosen: (table) => (!table.drop.air ? "none" : table.drop.air === true ? "air" : "given"),
      choose: (table, value) => { if (value === "none") delete table.drop.air; else if (value === "air") table.drop.air = true; },
    });
    const size = at(controls.resolved, ["plate", "size"]);
    const place = size && controls.resolved.plate.radius === undefined
      ? [["x", 0], ["y", 1]].map(([label, side]) => slider(controls, { path: ["drop", "position", side], label, unit: "mm", size: 1e-3, low: -500 * size[side], high: 500 * size[side] }))
      : [];
    // a velocity takes the place of speed and angle
    if (at(controls.resolved, ["drop", "velocity"]) !== undefined) {
      const ends = [[-20, 20], [-20, 20], [-20, "height" in controls.resolved.drop ? 20 : -0.05]];
      return [how, ...ends.map(([low, high], axis) => slider(controls, { path: ["drop", "velocity", axis], label: `Velocity ${"xyz"[axis]}`, unit: "m/s", low, high })), ...place, gravity, air];
    }
    const angle = bySpeed && isFlat(controls.resolved) ? [slider(controls, { path: ["drop", "angle"], label: "Angle", unit: "deg", size: Math.PI / 180, low: -85, high: 85, otherwise: 0 })] : [];
    return [how, bySpeed
      ? slider(controls, { path: ["drop", "speed"], label: "Speed", unit: "m/s", low: 0.05, high: 20, log: true })
      : slider(controls, { path: ["drop", "height"], label: "Height", unit: "m", low: 0.06, high: 10, log: true }),
    ...angle, ...place, gravity, air];
  };

  // The controls of the table of a case; `changed` is called after every change of it, with whether the control is let go.
  vibroimpact.Controls = class {
    constructor(form, changed) {
      this.form = form;
      this.changed = changed;
      this.table = null;
      this.resolved = null;
      this.offer = null;
      this.kept = {};
      this.ends = {};
      this.moving = false;
      this.beginning = false;
      this.shape = "";
      form.addEventListener("submit", (event) => event.preventDefault());
    }

    // Take another table, to be shown when it is resolved, or at once.
    begin(table, resolved = null) {
      this.table = table;
      this.beginning = resolved === null;
      this.moving = false;
      this.shape = "";
      this.kept = {};
      this.ends = {};
      if (resolved) this.show(table, resolved);
    }

    change(edit, settled, whole = false) {
      const table = structuredClone(this.table);
      edit(table);
      this.table = table;
      this.beginning = false;
      this.moving = !settled;
      if (whole) this.shape = "";
      this.changed(settled);
    }

    // Show a table and the case that came of it. The controls are made anew only where others are needed.
    show(table, resolved) {
      this.resolved = resolved;
      this.moving = false;
      this.beginning = false;
      const shape = JSON.stringify([
        table.contact.law, Object.entries(resolved.contact).map(([name, value]) => [name, Array.isArray(value) ? "list" : typeof value]), resolved.sphere.model, "mass" in resolved.sphere, "inertia" in resolved.sphere, resolved.plate.model, resolved.plate.material === "rigid", "height" in resolved.drop && !("speed" in table.drop),
        "velocity" in resolved.drop, "friction" in resolved.contact, "motion" in resolved.plate, table.plate.supports && resolved.plate.supports, typeof resolved.plate.damping, typeof resolved.sphere.damping,
        (table.sensors || []).map((sensor) => sensor.name), resolved.plate.size && resolved.plate.size.slice(0, 2), resolved.plate.radius === undefined,
      ]);
      if (shape !== this.shape) { this.shape = shape; this.build(); }
      for (const row of this.form.querySelectorAll(".row")) if (row.show) row.show();
    }

    build() {
      const focused = document.activeElement && document.activeElement.id;
      const plate = this.resolved.plate;
      const size = plate.size && plate.radius === undefined ? [["Length", 0, 100, 2000], ["Width", 1, 100, 2000], ["Thickness", 2, 1, 50]] : [];
      const inclination = isFlat(this.resolved) ? [slider(this, { path: ["plate", "inclination"], label: "Inclination", unit: "deg", size: Math.PI / 180, low: -60, high: 60, otherwise: 0 })] : [];
      const below = plate.radius !== undefined ? [slider(this, { path: ["plate", "radius"], label: "Radius", unit: "mm", size: 1e-3, low: 2, high: 200, log: true })] : [];
      const all = plate.model === "elastic" ? [group("Supports", ...supports(this)), group("Sensors", ...sensors(this))] : [];
      this.form.replaceChildren(
        group("Sphere", slider(this, { path: ["sphere", "radius"], label: "Radius", unit: "mm", size: 1e-3, low: 1, high: 100, log: true }), ...ball(this), ...material(this, "sphere"), ...bodyRows(this, "sphere")),
        group("Drop", ...drop(this)),
        this.law = group("Contact", ...law(this), ...friction(this)),
        group("Plate", ...below, ...inclination, ...size.map(([label, side, low, high]) => slider(this, { path: ["plate", "size", side], label, unit: "mm", size: 1e-3, low, high, log: true })), ...material(this, "plate"), ...bodyRows(this, "plate"), ...motion(this)),
        ...all,
        group("Run", slider(this, { path: ["run", "impacts"], label: "Impacts", low: 1, high: 30, whole: true })),
      );
      if (focused && document.getElementById(focused)) document.getElementById(focused).focus();
    }

    // Show what is asked for and could not be computed: the fields of the law that lacks a parameter.
    showAsked() {
      if (this.table.contact?.law === this.resolved?.contact.law) return;
      const asked = group("Contact", ...law(this), ...friction(this));
      this.law.replaceWith(asked);
      this.law = asked;
      this.shape = "";
      for (const row of asked.querySelectorAll(".row")) if (row.show) row.show();
    }

    // Return the keys of controls that a key of a message may be about, such as "sensors.a1.position" about "sensors.0.position.0".
    keysOf(key) {
      const list = this.table?.sensors || [];
      const number = (one, name) => one.findIndex((sensor) => sensor.name === name);
      let plain = key.replace(/^(.*)\.(length|width|thickness)$/, (_, part, name) => `${part}.${["length", "width", "thickness"].indexOf(name)}`)
        .replace(/^sensors \(the (\d+)\w+\)/, (_, place) => `sensors.${place - 1}`)
        .replace(/^sensors\.("[^"]*"|[^.]+)(?=\.)/, (whole, name) => { const index = number(list, name.replace(/^"|"$/g, "")); return index < 0 ? whole : `sensors.${index}`; })
        .replace(/\.x$/, ".0").replace(/\.y$/, ".1");
      if (key === "sensors") plain = `sensors.${list.findLastIndex((sensor, index) => number(list, sensor.name) < index)}.name`;
      return [key, plain, `${plain}.0`];
    }

    // Show the lines of a message at the controls that they are about.
    showFaults(lines) {
      for (const words of this.form.querySelectorAll(".fault-here")) words.remove();
      for (const field of this.form.querySelectorAll("[aria-invalid]")) { field.removeAttribute("aria-invalid"); field.removeAttribute("aria-describedby"); }
      for (const line of lines) {
        const key = /^(?:[^":]|"[^"]*")*/.exec(line)[0];   // a name in quotes may have a colon
        const row = this.keysOf(key).map((name) => this.form.querySelector(`[data-key="${CSS.escape(name)}"]`)).find(Boolean);
        if (!row) continue;
        const field = row.querySelector("input[type=number], input[type=text], select");
        const id = `f-${row.dataset.key.replaceAll(".", "-")}`;
        row.append(make("p", { class: "fault-here", id, text: line }));
        if (field) { field.setAttribute("aria-invalid", "true"); field.setAttribute("aria-describedby", id); }
      }
    }
  };
}
