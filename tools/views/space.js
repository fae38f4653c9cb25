// SPDX-License-Identifier: MIT
// Shared by pages of bodies: programs of WebGL, meshes, the way they are looked at, and controls.

const FOCAL = 2.2;

const BODY_VERTEX = `
attribute vec3 position, normal;
uniform mat4 view;
uniform vec4 quat;
uniform vec3 place;
uniform float nearer;
varying vec3 facing;
vec3 turned(vec3 v) { return v + 2.0 * cross(quat.xyz, cross(quat.xyz, v) + quat.w * v); }
void main() {
    facing = turned(normal);
    gl_Position = view * vec4(turned(position) + place, 1.0);
    gl_Position.z -= nearer * gl_Position.w;
}`;
const BODY_FRAGMENT = `
precision mediump float;
uniform vec4 colour;
uniform float part, plain;
varying vec3 facing;
void main() {
    if (part * (facing.z - 0.99) < 0.0)
        discard;
    float lit = 0.62 + 0.30 * dot(facing, vec3(0.36, -0.48, 0.8)) + 0.08 * facing.z;
    gl_FragColor = vec4(colour.rgb * mix(lit, 1.0, plain), colour.a);
}`;

function programOf(gl, vertex, fragment) {
    const made = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
            throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    return made;
}

const less = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => { const l = Math.hypot(...a) || 1; return a.map(x => x / l); };

/* The facets of a shape that is packed: each the loop of its corners. */
function loopsOf(shape) {
    const flat = new Float32Array(bytesOf(shape.points).buffer), next = reader(bytesOf(shape.facets));
    const corner = i => [flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]];
    return Array.from({length: next()}, () => Array.from({length: next()}, () => corner(next())));
}

/* The triangles of facets with their normals, the lines of their edges, and how far they reach. */
function meshOf(loops) {
    const triangles = [], lines = [];
    let radius = 0;
    for (const loop of loops) {
        const a = loop[0];
        let n = [0, 0, 0];
        for (let i = 2; i < loop.length; i++)
            n = cross(less(loop[i - 1], a), less(loop[i], a)).map((x, k) => x + n[k]);
        n = unit(n);
        for (let i = 2; i < loop.length; i++)
            triangles.push(...a, ...n, ...loop[i - 1], ...n, ...loop[i], ...n);
        for (let i = 0; i < loop.length; i++)
            lines.push(...loop[i], ...n, ...loop[(i + 1) % loop.length], ...n);
        radius = Math.max(radius, ...loop.map(p => Math.hypot(...p)));
    }
    return {triangles, lines, radius};
}

/*
 * Draws meshes. `begin` takes the matrix of the view, which facets are meant - all where `part` is 0, those that face
 * up where it is 1, all others where it is -1 - and whether colours are to stay as they are. `paint` takes the colour
 * of facets and how opaque these are, and the shade of lines, 0 for none.
 */
function painterOf(gl) {
    const made = programOf(gl, BODY_VERTEX, BODY_FRAGMENT);
    const at = Object.fromEntries(["view", "quat", "place", "colour", "part", "nearer", "plain"].map(
        name => [name, gl.getUniformLocation(made, name)]));
    const inputs = ["position", "normal"].map(name => gl.getAttribLocation(made, name));
    function show(mesh, name, how, colour) {
        gl.uniform4fv(at.colour, colour);
        gl.uniform1f(at.nearer, how === gl.LINES ? 3e-5 : 0); // lines are drawn over the facets that they bound
        gl.bindBuffer(gl.ARRAY_BUFFER, mesh[name + "Buffer"]);
        inputs.forEach((input, k) => gl.vertexAttribPointer(input, 3, gl.FLOAT, false, 24, 12 * k));
        gl.drawArrays(how, 0, mesh[name].length / 6);
    }
    return {
        keep(mesh) {
            for (const name of ["triangles", "lines"]) {
                mesh[name + "Buffer"] = gl.createBuffer();
                gl.bindBuffer(gl.ARRAY_BUFFER, mesh[name + "Buffer"]);
                gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(mesh[name]), gl.STATIC_DRAW);
            }
            return mesh;
        },
        drop(mesh) {
            for (const name of ["triangles", "lines"])
                gl.deleteBuffer(mesh[name + "Buffer"]);
        },
        begin(view, part, plain) {
            gl.useProgram(made);
            inputs.forEach(input => gl.enableVertexAttribArray(input));
            gl.uniformMatrix4fv(at.view, false, view);
            gl.uniform1f(at.part, part);
            gl.uniform1f(at.plain, plain ? 1 : 0);
        },
        paint(mesh, pose, colour, opaque, shade) {
            gl.uniform4fv(at.quat, pose.quat);
            gl.uniform3fv(at.place, pose.at);
            show(mesh, "triangles", gl.TRIANGLES, [...colour, opaque]);
            if (shade > 0)
                show(mesh, "lines", gl.LINES, [...colour.map(x => shade * x), opaque]);
        },
        end() {
            inputs.forEach(input => gl.disableVertexAttribArray(input));
        },
    };
}

/* Clears the picture to the colour of the paper that it is on. */
function clearPicture(gl, canvas) {
    const paper = getComputedStyle(canvas).backgroundColor.match(/[\d.]+/g).map(x => x / 255);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(paper[0], paper[1], paper[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
}

/* Places and quaternions between two, for a share from 0 to 1: it goes straight and turns evenly. */
function between(a, b, share) {
    const [p, q] = [a.quat, b.quat].map(quat => quat.map(x => x / (Math.hypot(...quat) || 1)));
    const along = p.reduce((sum, x, k) => sum + x * q[k], 0);
    const angle = Math.acos(Math.min(Math.abs(along), 1));
    const of = [1 - share, share].map(part => angle < 1e-6 ? part : Math.sin(part * angle) / Math.sin(angle));
    const quat = p.map((x, k) => of[0] * x + Math.sign(along || 1) * of[1] * q[k]);
    return {at: a.at.map((x, k) => x + share * (b.at[k] - x)), quat};
}

/* The matrix from the world to the picture, column by column. */
function viewOf(canvas, looking, scene) {
    const a = looking.azimuth * Math.PI / 180, e = looking.elevation * Math.PI / 180;
    const far = 2.9 * scene.radius / looking.zoom;
    const towards = [Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e)];
    const right = [-Math.sin(a), Math.cos(a), 0], up = cross(towards, right);
    const eye = towards.map((x, k) => scene.middle[k] + far * x), back = far + 40 * scene.radius, near = 0.02 * far;
    const wide = canvas.width / canvas.height, dot = (p, q) => p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    const rows = [[...right.map(x => FOCAL * x / wide), -FOCAL * dot(right, eye) / wide],
                  [...up.map(x => FOCAL * x), -FOCAL * dot(up, eye)]];
    const depth = (back + near) / (back - near), away = dot(towards, eye);
    rows.push([...towards.map(x => -depth * x), depth * away - 2 * back * near / (back - near)]);
    rows.push([...towards.map(x => -x), away]);
    return new Float32Array([0, 1, 2, 3].flatMap(c => rows.map(row => row[c])));
}

/*
 * The buttons, the slider and the keys of a page of bodies. `page` has the canvas, what `looking` is at first, `start`,
 * place() and last(), the places that may be shown, show(place), draw(), and rate(), the places of a second; `keys`
 * are those of its own.
 */
function controlsOf(page, keys) {
    let playing = false, before = null;
    const button = id => document.getElementById(id), slider = button("slider");
    function tick(now) {
        if (!playing)
            return;
        const next = page.place() + (before === null ? 0 : (now - before) * page.rate() / 1000);
        before = now;
        page.show(next >= page.last() ? 0 : next);
        requestAnimationFrame(tick);
    }
    function play(on) {
        playing = on;
        before = null;
        button("play").textContent = on ? "pause" : "play";
        if (on)
            requestAnimationFrame(tick);
    }
    /* One place, and no more playing. */
    function step(by) {
        play(false);
        page.show(by < 0 ? Math.ceil(page.place()) - 1 : Math.floor(page.place()) + 1);
    }
    function reset() {
        Object.assign(page.looking, page.start);
        page.draw();
    }
    function nearer(by) {
        page.looking.zoom = Math.min(50, Math.max(0.1, page.looking.zoom * by));
        page.draw();
    }
    const does = {
        " ": () => play(!playing), ArrowLeft: () => step(-1), ArrowRight: () => step(1), Home: () => page.show(0),
        End: () => page.show(page.last()), "+": () => nearer(1.2), "-": () => nearer(1 / 1.2), r: reset, ...keys,
    };
    slider.addEventListener("input", () => page.show(Number(slider.value)));
    for (const [id, key] of [["play", " "], ["back", "ArrowLeft"], ["on", "ArrowRight"], ["reset", "r"]])
        button(id).addEventListener("click", does[key]);
    document.addEventListener("keydown", event => {
        const on = document.activeElement; // which has keys of its own
        if (!does[event.key] || event.ctrlKey || event.altKey || event.metaKey || on.matches("select, input") ||
            (event.key === " " && on.matches("button")))
            return;
        event.preventDefault();
        does[event.key]();
    });
    turnByHand(page.canvas, page.looking, 89, page.draw);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", page.draw);
    return {play, reset};
}
