// Bodies in three dimensions: objects, moments of a scenario's path with the forces, poses of hard cases. A is grey, B
// the colour of sand. A measured arrow has the colour of its algorithm, an ideal one is grey; torques have two heads. Drawn when something changes, not all the time.

"use strict";

(function (report) {
  const element = report.element;
  const colours = { a: 0xa8b0b8, b: 0xd8c39a, ideal: 0x8a8a8a, curve: 0xb03030 };
  const numbersOfMoment = { pose: [0, 7], force: [7, 10], idealForce: [10, 13], torque: [13, 16], idealTorque: [16, 19] };
  const parts = (moment) => Object.fromEntries(Object.entries(numbersOfMoment).map(([name, [from, to]]) => [name, moment.slice(from, to)]));

  function geometryOf(mesh) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(mesh.vertices, 3));
    geometry.setIndex(mesh.triangles);
    geometry.computeVertexNormals();
    geometry.computeBoundingBox();
    return geometry;
  }

  function solidOf(mesh, colour, opacity) {
    const material = new THREE.MeshStandardMaterial({ color: colour, roughness: 0.75, metalness: 0, flatShading: true, side: THREE.DoubleSide,
                                                      transparent: opacity < 1, opacity, depthWrite: opacity === 1 });
    return new THREE.Mesh(geometryOf(mesh), material);
  }

  function lights(scene) {
    scene.add(new THREE.HemisphereLight(0xffffff, 0x667788, 1.6));
    const light = new THREE.DirectionalLight(0xffffff, 1.8);
    light.position.set(1, -1.5, 2);
    scene.add(light);
  }

  /** Shaft and head, of a torque two. The ideal one is thicker, so that it frames a measured one that agrees with it. */
  function arrowOf(from, direction, length, radius, name, colour) {
    const isIdeal = name.startsWith("ideal"), thick = (isIdeal ? 0.02 : 0.01) * radius, head = Math.min(0.4 * length, 0.14 * radius);
    const material = new THREE.MeshBasicMaterial({ color: isIdeal ? colours.ideal : colour, depthTest: false, transparent: true });
    const shaft = new THREE.Mesh(new THREE.CylinderGeometry(thick, thick, length - head, 12), material);
    shaft.position.y = (length - head) / 2;
    const heads = (/torque/i.test(name) ? [0, 1] : [0]).map((k) => {
      const cone = new THREE.Mesh(new THREE.ConeGeometry((isIdeal ? 0.065 : 0.05) * radius, head, 16), material);
      cone.position.y = length - (k + 0.5) * head;
      return cone;
    });
    const arrow = new THREE.Group();
    for (const piece of [shaft, ...heads]) {
      piece.renderOrder = isIdeal ? 2 : 3;
      arrow.add(piece);
    }
    arrow.position.copy(from);
    arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), direction);
    return arrow;
  }

  /** A renderer, or null where the browser has no WebGL. */
  function makeRenderer(width, height) {
    try {
      const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
      renderer.setPixelRatio(Math.min(2, devicePixelRatio));
      renderer.setSize(width, height);
      return renderer;
    } catch (error) {
      return null;
    }
  }

  /** Scanned objects stand on their z, x plane, and so does the block of Ia and Ib (scenario/README.md). */
  const standsOnY = (scene) => scene.kind === "object" || scene.kind === "pose" || /^I[ab]:/.test(scene.name);

  /** A camera on a sphere around a box; z is up, or y. */
  class Orbit {
    constructor(box, yIsUp) {
      this.camera = new THREE.PerspectiveCamera(35, 1, 1e-3, 1e4);
      this.yIsUp = yIsUp;
      this.camera.up.set(0, yIsUp ? 1 : 0, yIsUp ? 0 : 1);
      this.centre = box.getCenter(new THREE.Vector3());
      this.radius = box.getSize(new THREE.Vector3()).length() / 2 || 1;
      this.distance = 3.4 * this.radius;
      this.around = yIsUp ? 0.6 : -0.9;
      this.above = yIsUp ? 0.25 : 0.45;
    }
    place(aspect) {
      const far = this.distance * Math.max(1, 1 / aspect);
      this.above = Math.min(1.5, Math.max(-1.5, this.above));
      this.camera.aspect = aspect;
      this.camera.near = Math.max(far - 20 * this.radius, far / 1000);
      this.camera.far = far + 20 * this.radius;
      const [x, y, z] = [Math.cos(this.above) * Math.cos(this.around), Math.cos(this.above) * Math.sin(this.around), Math.sin(this.above)];
      this.camera.position.set(...(this.yIsUp ? [y, z, x] : [x, y, z])).multiplyScalar(far).add(this.centre);
      this.camera.lookAt(this.centre);
      this.camera.updateProjectionMatrix();
      return this.camera;
    }
  }

  /** Pictures of the objects, one renderer for all: a browser has few. */
  report.objectPictures = function (data) {
    const objects = data.scenes.filter((scene) => scene.kind === "object");
    const renderer = objects.length ? makeRenderer(280, 220) : null;
    if (!renderer) return null;
    const pictures = objects.map((each) => {
      const scene = new THREE.Scene();
      lights(scene);
      const solid = solidOf(data.meshes[each.a], 0xb9c4cf, 1);
      scene.add(solid);
      renderer.render(scene, new Orbit(solid.geometry.boundingBox, true).place(280 / 220));
      const count = data.meshes[each.a].before.toLocaleString("en");
      const picture = element("img", { src: renderer.domElement.toDataURL(), width: 280, height: 220, alt: `${each.name}, ${count} triangles` });
      solid.geometry.dispose();
      return element("figure", {}, picture, element("figcaption", {}, element("strong", {}, each.name), ` ${count} triangles`));
    });
    renderer.dispose();
    return element("section", { class: "figure" }, element("h3", {}, "The objects"), element("div", { class: "pictures" }, ...pictures),
      element("p", { class: "caption" }, "Drawn with fewer triangles than they have."));
  };

  class SceneView {
    constructor(data) {
      this.data = data;
      this.select = element("select", { onchange: () => this.choose(Number(this.select.value)) },
        ...this.groups());
      this.slider = element("input", { type: "range", min: 0, value: 0, "aria-label": "moment along the path", oninput: () => this.update() });
      this.note = element("p", { class: "caption", "aria-live": "polite" });
      this.place = element("div", { class: "scene", tabindex: 0, role: "img", "aria-label": "Bodies in three dimensions; arrow keys turn, plus and minus zoom" });
      this.play = element("button", { type: "button", onclick: () => this.toggle() }, "play");
      this.command = element("div");
      this.key = element("div", { class: "chips" });
      this.element = element("section", { class: "figure", id: "figure-view" },
        element("div", { class: "controls" }, element("label", {}, "Show ", this.select), this.play, this.slider), this.place, this.key, this.note, this.command);
      this.choose(0);
    }

    /** Choices by kind. Poses of rows are too many for a list: a link chooses one, and it stands in the list then. */
    groups() {
      const kinds = { path: "Paths", case: "Hard cases", object: "Objects" };
      this.linked = element("optgroup", { label: "From a figure", hidden: true });
      return [this.linked, ...Object.entries(kinds).map(([kind, label]) => {
        const options = this.data.scenes.flatMap((scene, i) => (scene.kind === kind ? [element("option", { value: i }, scene.name)] : []));
        return options.length ? element("optgroup", { label }, ...options) : null;
      }).filter(Boolean)];
    }

    style() { return report.styleOf(this.scene.algorithm, this.data.algorithms); }

    legend() {
      const entry = (colour, shape, text) => {
        const swatch = element("span", { class: "swatch " + shape });
        swatch.style.setProperty("--colour", typeof colour === "number" ? "#" + colour.toString(16).padStart(6, "0") : colour);
        return element("span", { class: "chip" }, swatch, text);
      };
      const { algorithm, kind } = this.scene, style = this.style();
      const hasArrows = Object.values(this.peaks).some((peak) => peak > 0);
      return [entry(colours.a, "", "A, fixed"), kind === "object" ? null : entry(colours.b, "", "B, moving"),
              algorithm ? entry(report.colourOf(style, report.theme), report.shapeOf(style), hasArrows ? `${algorithm}: force, and torque with two heads` : algorithm) : null,
              hasArrows ? entry(colours.ideal, "", "ideal or exact ones") : null,
              this.scene.curve?.length ? entry(colours.curve, "", "curve in which the surfaces cross; arrows: contacts with their normals") : null].filter(Boolean);
    }

    /** Once the element is in the page: it has a size then. */
    attach() {
      if (!this.renderer) {
        this.renderer = makeRenderer(this.place.clientWidth || 600, 460);
        if (!this.renderer) {
          this.place.replaceChildren(element("p", { class: "empty" }, "This browser has no WebGL."));
          return;
        }
        this.place.append(this.renderer.domElement);
        this.listen();
      }
      this.draw();
    }

    listen() {
      let from = null;
      const move = (around, above) => { this.orbit.around += around; this.orbit.above += above; this.draw(); };
      const zoom = (factor) => { this.orbit.distance *= factor; this.draw(); };
      this.place.addEventListener("pointerdown", (event) => { from = [event.clientX, event.clientY]; this.place.setPointerCapture(event.pointerId); });
      this.place.addEventListener("pointermove", (event) => {
        if (!from) return;
        move((from[0] - event.clientX) / 120, (event.clientY - from[1]) / 120);
        from = [event.clientX, event.clientY];
      });
      this.place.addEventListener("pointerup", () => { from = null; });
      this.place.addEventListener("wheel", (event) => { event.preventDefault(); zoom(Math.exp(event.deltaY / 800)); }, { passive: false });
      this.place.addEventListener("keydown", (event) => {
        const turns = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, 0.15], ArrowDown: [0, -0.15] };
        if (turns[event.key]) { event.preventDefault(); move(...turns[event.key]); }
        if (event.key === "+" || event.key === "=") zoom(0.85);
        if (event.key === "-") zoom(1.18);
      });
    }

    /** Without a moment, a path begins where its force is the largest. */
    choose(index, wanted) {
      this.stop();
      const scene = this.scene = this.data.scenes[index];
      if (scene.kind === "pose") {
        this.linked.replaceChildren(element("option", { value: index }, scene.name));
        this.linked.hidden = false;
      }
      const sizes = scene.moments.map((each) => Math.hypot(...parts(each).force));
      const moment = wanted ?? Math.max(0, sizes.indexOf(Math.max(...sizes)));
      this.select.value = String(index);
      const isPath = scene.moments.length > 1;
      this.slider.max = String(Math.max(0, scene.moments.length - 1));
      this.slider.value = String(moment);
      this.slider.hidden = this.play.hidden = !isPath;
      this.space = new THREE.Scene();
      lights(this.space);
      this.a = solidOf(this.data.meshes[scene.a], colours.a, scene.kind === "object" ? 1 : 0.55);
      this.space.add(this.a);
      const box = new THREE.Box3().copy(this.a.geometry.boundingBox);
      this.b = null;
      if (scene.kind !== "object") {
        this.b = solidOf(this.data.meshes[scene.b], colours.b, 0.9);
        this.space.add(this.b);
        for (const each of [scene.moments[0], scene.moments[scene.moments.length - 1]]) {
          this.pose(each);
          box.union(new THREE.Box3().setFromObject(this.b));
        }
      }
      this.orbit = new Orbit(box, standsOnY(scene));
      this.drawContacts();
      this.follow(box);
      this.peaks = ["force", "idealForce", "torque", "idealTorque"].map((name) =>
        [name, Math.max(0, ...scene.moments.map((each) => Math.hypot(...parts(each)[name])))]);
      this.peaks = Object.fromEntries(this.peaks);
      this.command.replaceChildren(...(scene.command ? [report.commandLine(scene.command)] : []));
      this.key.replaceChildren(...this.legend());
      this.update();
    }

    /** On a path that is long for B, the camera stays with B. */
    follow(box) {
      this.follows = false;
      if (!this.b) return;
      this.b.geometry.computeBoundingSphere();
      const size = this.b.geometry.boundingSphere.radius;
      if (this.scene.kind !== "path" || box.getSize(new THREE.Vector3()).length() < 8 * size) return;
      this.follows = true;
      this.orbit.radius = 1.6 * size;
      this.orbit.distance = 4 * this.orbit.radius;
    }

    pose(moment) {
      const [w, x, y, z, tx, ty, tz] = parts(moment).pose;
      this.b.quaternion.set(x, y, z, w);
      this.b.position.set(tx, ty, tz);
      this.b.updateMatrixWorld(true);
    }

    /** The magnitude whose arrow is longest. Units of measured and ideal differ, so that each series has its own; a torque
     * that should be zero is measured by the force at the end of the bodies. */
    fullOf(name) {
      if (name === "torque" && this.peaks.idealTorque === 0) return this.peaks.force * this.orbit.radius;
      return this.peaks[name];
    }

    drawArrows(moment) {
      if (this.arrows) this.space.remove(this.arrows);
      this.arrows = new THREE.Group();
      const from = new THREE.Vector3(...this.scene.reference).applyMatrix4(this.b.matrixWorld);
      for (const name of ["idealForce", "force", "idealTorque", "torque"]) {
        const vector = new THREE.Vector3(...parts(moment)[name]);
        const full = this.fullOf(name), share = full > 0 ? vector.length() / full : 0;
        if (share < 0.005) continue;
        const length = 0.8 * this.orbit.radius * share;
        this.arrows.add(arrowOf(from, vector.normalize(), length, this.orbit.radius, name, report.colourOf(this.style(), report.theme)));
      }
      this.space.add(this.arrows);
    }

    /** Contacts as arrows along their normals, from A to B, and the curve in which the surfaces cross. */
    drawContacts() {
      const { contacts = [], curve = [] } = this.scene, radius = 0.35 * this.orbit.radius;
      for (const [x, y, z, ...normal] of contacts) {
        this.space.add(arrowOf(new THREE.Vector3(x, y, z), new THREE.Vector3(...normal).normalize(), 0.4 * radius, radius, "contact",
          report.colourOf(this.style(), report.theme)));
      }
      if (curve.length === 0) return;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.Float32BufferAttribute(curve.flat(), 3));
      const line = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colours.curve, depthTest: false, transparent: true }));
      line.renderOrder = 1;
      this.space.add(line);
    }

    update() {
      const scene = this.scene, k = Number(this.slider.value);
      const before = (mesh) => this.data.meshes[mesh].before.toLocaleString("en");
      if (scene.kind === "object") {
        this.note.textContent = `${before(scene.a)} triangles, drawn with ${(this.data.meshes[scene.a].triangles.length / 3).toLocaleString("en")}.`;
      } else {
        this.pose(scene.moments[k]);
        if (this.follows) this.orbit.centre.copy(this.b.geometry.boundingSphere.center).applyMatrix4(this.b.matrixWorld);
        this.drawArrows(scene.moments[k]);
        const what = scene.kind === "path" ? `${(1000 * k * scene.stride / scene.rate_hz).toFixed(0)} ms along the path.`
          : scene.kind === "pose" ? `${scene.name}. The command below asks at this pose.` : "The pose at which this algorithm's answer was the worst.";
        this.note.textContent = `${what} Drag to turn, wheel to zoom.`;
      }
      this.draw();
    }

    draw() {
      if (!this.renderer) return;
      const width = this.place.clientWidth || 600, height = Math.min(460, Math.max(260, 0.6 * width));
      this.renderer.setSize(width, height);
      this.renderer.render(this.space, this.orbit.place(width / height));
      this.element.dataset.drawn = String(this.renderer.info.render.triangles);
    }

    toggle() {
      if (this.timer) { this.stop(); return; }
      this.play.textContent = "stop";
      this.timer = setInterval(() => {
        this.slider.value = String((Number(this.slider.value) + 1) % this.scene.moments.length);
        this.update();
      }, 40);
    }

    stop() {
      clearInterval(this.timer);
      this.timer = null;
      this.play.textContent = "play";
    }
  }
  report.SceneView = SceneView;
})(globalThis.sixdofReport);
