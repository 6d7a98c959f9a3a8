// The plate in motion with ball, supports and sensors, on a canvas: parallel projection, turned by dragging.
"use strict";

{
  const MOST_CELLS = 64;      // along the longer side: more can't be seen
  const MILLISECONDS = 70;    // of a frame at usual speed
  const BETWEEN = 32;         // two pictures, so that charts are drawn as well [ms]

  const rgb = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

  // Return 256 shades between stops at even distances.
  const between = (stops) => Array.from({ length: 256 }, (_, index) => {
    const place = index / 255 * (stops.length - 1), low = Math.min(Math.floor(place), stops.length - 2);
    const [first, last] = [rgb(stops[low]), rgb(stops[low + 1])];
    return `rgb(${first.map((value, part) => Math.round(value + (place - low) * (last[part] - value))).join()})`;
  });

  // Return the shades of deflections on the ground of now, those of the palette that charts are given.
  const known = new Map();
  const shadesNow = () => {
    const stops = vibroimpact.palette[vibroimpact.theme].diverging;
    if (!known.has(stops)) known.set(stops, between(stops));
    return known.get(stops);
  };

  const PERIOD_FRAMES = 24;

  // Return a scene of one period of a mode, which begins and ends at its largest displacement.
  const periodOf = (scene, { period, shape }) => {
    const swing = Array.from({ length: PERIOD_FRAMES + 1 }, (_, frame) => Math.cos(2 * Math.PI * frame / PERIOD_FRAMES));
    const height = new Float32Array(swing.length * shape.length);
    swing.forEach((part, frame) => shape.forEach((value, at) => { height[frame * shape.length + at] = part * value; }));
    return { ...scene, height, time: swing.map((_, frame) => period * frame / PERIOD_FRAMES), clock: "of one period" };
  };

  const clockText = (time, words) => {
    const size = Math.abs(time);
    const [value, unit] = size < 1e-3 ? [time * 1e6, "µs"] : size < 1 ? [time * 1e3, "ms"] : [time, "s"];
    return `${Math.abs(value).toPrecision(3)} ${unit} ${words || (time < 0 ? "before first touch" : "after first touch")}`;
  };

  vibroimpact.Scene = class {
    // `tell` is called with the place among the frames, from 0 to 1, and the time in words; `moved`, where there is one, with the place
    // on the plate to which the ball is dragged, and whether it is let go there.
    constructor(canvas, scene, tell = () => {}, moved = null) {
      this.canvas = canvas;
      this.tell = tell;
      this.moved = moved;
      this.turn = -0.56;
      this.tilt = 0.42;
      this.speed = 1;
      this.frame = 0;
      this.playing = false;
      this.waiting = false;     // it stands, though it is playing
      this.setScene(scene);
      this.listen();
      new ResizeObserver(() => this.draw()).observe(canvas);
    }

    setScene(scene) {
      const columns = scene.x.length, rows = scene.y.length;
      const step = Math.max(1, Math.ceil(Math.max(columns, rows) / MOST_CELLS));
      const kept = (count) => [...new Set([...Array.from({ length: Math.ceil(count / step) }, (_, index) => index * step), count - 1])];
      this.scene = scene;
      this.columns = kept(columns);
      this.rows = kept(rows);
      this.most = scene.height.reduce((most, value) => (Math.abs(value) > most ? Math.abs(value) : most), 0) || 1;
      this.frames = scene.time.length;
      this.frame = Math.min(this.frame, this.frames - 1);
      this.draw();
    }

    listen() {
      let from = null, ball = false, dragged = false, grip = [0, 0], box = null;
      // where the canvas was when it was gripped: the page may be laid out anew meanwhile
      const place = (event) => [event.clientX - box.left, event.clientY - box.top];
      const within = (value, ends) => Math.min(Math.max(value, ends[0]), ends[ends.length - 1]);
      // the place of the ball on the plate: it is held where it was gripped
      const under = (event) => { const seen = this.onPlate(...place(event)); return [within(seen[0] - grip[0], this.scene.x), within(seen[1] - grip[1], this.scene.y)]; };
      this.canvas.addEventListener("pointerdown", (event) => {
        from = [event.clientX, event.clientY, this.turn, this.tilt];
        dragged = false;
        box = this.canvas.getBoundingClientRect();
        const [x, y] = place(event);
        ball = Boolean(this.moved) && [this.foot, this.ball].some((at) => at && Math.hypot(x - at[0], y - at[1]) < Math.max(16, 1.2 * at[2]));
        this.canvas.setPointerCapture(event.pointerId);
        if (ball) { event.preventDefault(); const seen = this.onPlate(x, y); const at = this.scene.path ? this.scene.path.map((values) => this.between(values)) : this.scene.contact; grip = Array.from(at, (one, side) => seen[side] - one); }
      });
      this.canvas.addEventListener("pointermove", (event) => {
        if (!from) return;
        dragged = true;
        if (ball) { this.moved(...under(event), false); return; }
        this.turn = from[2] + (event.clientX - from[0]) / 200;
        this.tilt = Math.min(Math.max(from[3] + (event.clientY - from[1]) / 250, 0.08), Math.PI / 2);
        this.draw();
      });
      // a click that moves nothing changes nothing
      this.canvas.addEventListener("pointerup", (event) => { if (ball && dragged) this.moved(...under(event), true); from = null; ball = false; });
      this.canvas.addEventListener("pointercancel", () => { from = null; ball = false; });
      this.canvas.addEventListener("keydown", (event) => {
        const moves = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.08], ArrowDown: [0, -0.08] };
        if (!(event.key in moves)) return;
        event.preventDefault();
        this.turn += moves[event.key][0];
        this.tilt = Math.min(Math.max(this.tilt + moves[event.key][1], 0.08), Math.PI / 2);
        this.draw();
      });
    }

    // Return the place in the plane of the plate that is seen at a place of the canvas.
    onPlate(across, down) {
      const { seen } = this;
      const a = (across - seen.centre[0]) / seen.scale, b = (seen.centre[1] - down) / seen.scale / Math.sin(this.tilt);
      return [seen.middle[0] + a * Math.cos(this.turn) + b * Math.sin(this.turn), seen.middle[1] - a * Math.sin(this.turn) + b * Math.cos(this.turn)];
    }

    play() {
      if (this.playing) return;
      this.playing = true;
      let before = performance.now();
      const next = (now) => {
        if (!this.playing) return;
        if (this.waiting) before = now;
        else if (now - before >= BETWEEN) {
          this.seek((this.frame + this.speed * (now - before) / MILLISECONDS) % (this.frames - 1));
          before = now;
        }
        requestAnimationFrame(next);
      };
      requestAnimationFrame(next);
    }

    pause() { this.playing = false; }

    // Show the frame at a place among the frames, from 0 to their number less 1.
    seek(frame) { this.frame = Math.min(Math.max(frame, 0), this.frames - 1); this.draw(); }

    get time() { return this.between(this.scene.time); }

    between(values) {
      const low = Math.min(Math.floor(this.frame), this.frames - 2), part = this.frame - low;
      return this.frames < 2 ? values[0] : values[low] + part * (values[low + 1] - values[low]);
    }

    draw() {
      const { canvas, scene } = this;
      const width = canvas.clientWidth, height = canvas.clientHeight, ratio = window.devicePixelRatio || 1;
      if (!width || !height) return;
      if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
      if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
      const pen = canvas.getContext("2d");
      const soft = getComputedStyle(canvas).getPropertyValue("--soft").trim() || "#5a5a5a";
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      pen.clearRect(0, 0, width, height);
      const half = [0.5 * (scene.x[scene.x.length - 1] - scene.x[0]), 0.5 * (scene.y[scene.y.length - 1] - scene.y[0])];
      const middle = [scene.x[0] + half[0], scene.y[0] + half[1]];
      const reach = Math.hypot(...half);
      const [wide, deep] = [Math.abs(half[0] * Math.cos(this.turn)) + Math.abs(half[1] * Math.sin(this.turn)), Math.abs(half[0] * Math.sin(this.turn)) + Math.abs(half[1] * Math.cos(this.turn))];
      const above = scene.gap_scale < 1 ? 1.25 * Math.max(...half) : 0.3 * reach + 2 * (scene.radius || 0);
      const below = 0.26 * Math.max(...half);
      const scale = Math.min(width / (2.3 * wide), height / (2 * deep * Math.sin(this.tilt) + (above + below) * Math.cos(this.tilt)) / 1.06);
      const [sin, cos] = [Math.sin(this.turn), Math.cos(this.turn)];
      const [rise, lift] = [Math.sin(this.tilt), Math.cos(this.tilt)];
      const centre = [0.5 * width, 0.5 * height + 0.5 * scale * (above - below) * lift];
      const place = (x, y, z) => {
        const [u, v] = [x - middle[0], y - middle[1]];
        return [centre[0] + scale * (u * cos - v * sin), centre[1] - scale * ((u * sin + v * cos) * rise + z * lift)];
      };
      this.seen = { centre, scale, middle };
      const factor = scene.exaggeration;
      this.drawSupports(pen, place, soft);
      this.drawHeld(pen, place, soft);
      this.drawPlate(pen, place, factor, [sin, cos]);
      const feet = scene.sensors.map(({ x, y }) => place(x, y, factor * this.nearest(x, y)));
      this.drawSensors(pen, feet);
      if (scene.radius) this.drawBall(pen, place, scale, factor, rise);
      this.nameSensors(pen, feet);
      this.tell(this.frames > 1 ? this.frame / (this.frames - 1) : 0, clockText(this.time, scene.clock));
    }

    heightAt(row, column) {
      const { scene } = this;
      const size = scene.x.length * scene.y.length, low = Math.min(Math.floor(this.frame), Math.max(this.frames - 2, 0));
      const at = row * scene.x.length + column, part = this.frame - low;
      const first = scene.height[low * size + at];
      return this.frames < 2 ? first : first + part * (scene.height[(low + 1) * size + at] - first);
    }

    drawPlate(pen, place, factor, [sin, cos]) {
      const { scene, columns, rows } = this, shade = shadesNow();
      const corners = rows.map((row) => columns.map((column) => {
        const height = this.heightAt(row, column);
        return [...place(scene.x[column], scene.y[row], factor * height), height];
      }));
      // the farthest cells first; a cell without a corner is outside of the plate
      const across = [...columns.keys()].slice(0, -1), along = [...rows.keys()].slice(0, -1);
      if (sin > 0) across.reverse();
      if (cos > 0) along.reverse();
      const columnsFirst = Math.abs(sin) < Math.abs(cos);
      const edge = scene.outline ? this.outlinePath(place, factor) : this.edgePath(corners);
      pen.save();
      // the grid reaches a little beyond an outline that is not its own
      if (scene.outline) pen.clip(edge);
      const cell = (row, column) => {
        const four = [corners[row][column], corners[row][column + 1], corners[row + 1][column + 1], corners[row + 1][column]];
        const mean = 0.25 * (four[0][2] + four[1][2] + four[2][2] + four[3][2]);
        if (!Number.isFinite(mean)) return;
        pen.fillStyle = pen.strokeStyle = shade[Math.round(127.5 * (1 + mean / this.most))];
        pen.beginPath();
        four.forEach(([x, y], index) => (index ? pen.lineTo(x, y) : pen.moveTo(x, y)));
        pen.closePath();
        pen.fill();
        pen.stroke();
      };
      pen.lineWidth = 0.6;
      if (columnsFirst) for (const row of along) for (const column of across) cell(row, column);
      else for (const column of across) for (const row of along) cell(row, column);
      pen.restore();
      pen.lineWidth = 0.6;
      pen.strokeStyle = "rgba(60, 60, 60, 0.8)";
      pen.stroke(edge);
    }

    // Return the path around a rectangular grid.
    edgePath(corners) {
      const path = new Path2D();
      const edge = [
        ...corners[0], ...corners.map((row) => row[row.length - 1]), ...[...corners[corners.length - 1]].reverse(), ...corners.map((row) => row[0]).reverse(),
      ].filter((corner) => Number.isFinite(corner[2]));
      edge.forEach(([x, y], index) => (index ? path.lineTo(x, y) : path.moveTo(x, y)));
      return path;
    }

    // Return the path of the outline and of holes in it, on the deformed plate: long straight parts bend too.
    outlinePath(place, factor) {
      const { outline, x: across, y: along } = this.scene, path = new Path2D();
      const step = 0.03 * Math.max(across[across.length - 1] - across[0], along[along.length - 1] - along[0]);
      let before = null;
      for (let index = 0; index < outline.length; index += 2) {
        const [x, y] = [outline[index], outline[index + 1]];
        if (!Number.isFinite(x)) { before = null; continue; }
        if (!before) path.moveTo(...place(x, y, factor * this.heightNear(x, y)));
        else {
          const parts = Math.max(1, Math.ceil(Math.hypot(x - before[0], y - before[1]) / step));
          for (let part = 1; part <= parts; part++) {
            const at = [before[0] + part / parts * (x - before[0]), before[1] + part / parts * (y - before[1])];
            path.lineTo(...place(...at, factor * this.heightNear(...at)));
          }
        }
        before = [x, y];
      }
      return path;
    }

    // Return the deflection at a place, between the grid points around it that have one.
    heightNear(x, y) {
      const { scene } = this;
      const side = (values, value) => {
        const at = Math.min(Math.max((value - values[0]) / (values[1] - values[0]), 0), values.length - 1), low = Math.min(Math.floor(at), values.length - 2);
        return [[low, 1 - at + low], [low + 1, at - low]];
      };
      let sum = 0, weight = 0;
      for (const [row, up] of side(scene.y, y)) for (const [column, across] of side(scene.x, x)) {
        const height = this.heightAt(row, column);
        if (Number.isFinite(height)) { sum += up * across * height; weight += up * across; }
      }
      return weight ? sum / weight : 0;
    }

    drawSupports(pen, place, colour) {
      const { scene } = this;
      const length = 0.12 * Math.max(scene.x[scene.x.length - 1] - scene.x[0], scene.y[scene.y.length - 1] - scene.y[0]);
      pen.fillStyle = colour;
      for (const outline of scene.supports) {
        const points = Array.from({ length: outline.length / 2 }, (_, index) => [outline[2 * index], outline[2 * index + 1]]);
        for (const depth of [-length, 0]) {
          pen.globalAlpha = depth ? 0.35 : 0.6;
          pen.beginPath();
          points.forEach(([x, y], index) => { const at = place(x, y, depth); if (index) pen.lineTo(...at); else pen.moveTo(...at); });
          pen.closePath();
          pen.fill();
        }
        pen.globalAlpha = 0.25;
        const flat = points.map(([x, y]) => [place(x, y, 0), place(x, y, -length)]);
        const left = flat.reduce((best, pair) => (pair[0][0] < best[0][0] ? pair : best)), right = flat.reduce((best, pair) => (pair[0][0] > best[0][0] ? pair : best));
        pen.beginPath();
        pen.moveTo(...left[0]); pen.lineTo(...right[0]); pen.lineTo(...right[1]); pen.lineTo(...left[1]);
        pen.closePath();
        pen.fill();
        pen.globalAlpha = 1;
      }
    }

    // The nodes of sets that are held: they stay where they are.
    drawHeld(pen, place, colour) {
      const { held = [] } = this.scene;
      pen.fillStyle = colour;
      for (let index = 0; index < held.length; index += 3) {
        const [across, up] = place(held[index], held[index + 1], held[index + 2]);
        pen.fillRect(across - 1.5, up - 1.5, 3, 3);
      }
    }

    nearest(x, y) {
      const { scene } = this;
      const index = (values, value) => values.reduce((best, one, number) => (Math.abs(one - value) < Math.abs(values[best] - value) ? number : best), 0);
      const height = this.heightAt(index(scene.y, y), index(scene.x, x));
      return Number.isFinite(height) ? height : 0;
    }

    drawSensors(pen, feet) {
      pen.fillStyle = "#c79000";
      pen.strokeStyle = "#3a2c00";
      for (const [across, up] of feet) {
        pen.beginPath();
        pen.moveTo(across, up - 9); pen.lineTo(across - 5, up); pen.lineTo(across + 5, up);
        pen.closePath();
        pen.fill();
        pen.stroke();
      }
    }

    // Names stand beside their sensors, or above where there is no room; lower, if they would lie over the ball, other sensors and names.
    nameSensors(pen, feet) {
      const taken = feet.map(([across, up]) => [across - 6, across + 6, up - 9, up]);
      if (this.scene.radius && this.ball) {
        const [x, y, radius] = this.ball;
        taken.push([x - radius, x + radius, y - radius, y + radius]);
      }
      pen.font = "12px system-ui, sans-serif";
      pen.strokeStyle = "rgba(255, 255, 255, 0.75)";
      pen.fillStyle = "#1b1b1b";
      pen.lineWidth = 3;
      this.scene.sensors.forEach(({ name }, index) => {
        const [across, up] = feet[index], words = name.length > 24 ? `${name.slice(0, 22)}…` : name;
        const width = pen.measureText(words).width, left = Math.min(across + 8, this.canvas.clientWidth - width - 2);
        let line = left < across + 8 ? up - 12 : up - 3;
        while (taken.some(([start, end, top, bottom]) => left < end && left + width > start && line - 10 < bottom && line + 3 > top)) line += 13;
        taken.push([left, left + width, line - 10, line + 3]);
        pen.strokeText(words, left, line);
        pen.fillText(words, left, line);
      });
    }

    drawBall(pen, place, scale, factor, rise) {
      const { scene } = this;
      const down = this.between(scene.contact_height), height = factor * down + scene.radius + scene.gap_scale * (this.between(scene.sphere) - scene.radius - down);
      const radius = scale * scene.radius;
      const [along, across] = scene.path ? scene.path.map((values) => this.between(values)) : scene.contact;
      const foot = place(along, across, factor * down), [x, y] = place(along, across, height);
      this.foot = [...foot, radius];
      this.ball = [x, y, radius];
      pen.fillStyle = "rgba(0, 0, 0, 0.28)";
      pen.beginPath();
      pen.ellipse(foot[0], foot[1], radius, radius * rise, 0, 0, 2 * Math.PI);
      pen.fill();
      const shade = pen.createRadialGradient(x - 0.35 * radius, y - 0.4 * radius, 0.1 * radius, x, y, radius);
      shade.addColorStop(0, "#e2dccf");
      shade.addColorStop(1, "#5d554b");
      pen.fillStyle = shade;
      pen.strokeStyle = "#2b2722";
      pen.beginPath();
      pen.arc(x, y, radius, 0, 2 * Math.PI);
      pen.fill();
      pen.stroke();
    }
  };

  // Connect the buttons and sliders beside a canvas with its scene: play, the place among the frames, speed; the mode, if it has several.
  vibroimpact.controlScene = (figure, scene, moved = null) => {
    const [play, place, speed, clock, mode] = ["play", "place", "speed", "clock", "mode"].map((name) => figure.querySelector(`[data-scene=${name}]`));
    const shown = () => (mode ? periodOf(scene, scene.modes[Number(mode.value)]) : scene);
    const drawn = new vibroimpact.Scene(figure.querySelector("canvas"), shown(), (part, words) => {
      place.value = String(Math.round(1000 * part));
      place.setAttribute("aria-valuetext", words);
      clock.textContent = words;
    }, moved);
    const show = () => { play.textContent = drawn.playing ? "Pause" : "Play"; };
    play.addEventListener("click", () => { if (drawn.playing) drawn.pause(); else drawn.play(); show(); });
    place.addEventListener("input", () => { drawn.pause(); show(); drawn.seek(Number(place.value) / 1000 * (drawn.frames - 1)); });
    speed.addEventListener("change", () => { drawn.speed = Number(speed.value); });
    mode?.addEventListener("change", () => drawn.setScene(shown()));
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) {
      new IntersectionObserver(([entry], observer) => { if (entry.isIntersecting) { observer.disconnect(); drawn.play(); show(); } }).observe(figure);
    }
    show();
    return drawn;
  };
}
