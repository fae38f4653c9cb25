// SPDX-License-Identifier: MIT
// What the pages share: packed numbers, the legend, and a canvas that is turned by dragging.

function bytesOf(text) {
    const packed = atob(text), bytes = new Uint8Array(packed.length);
    for (let i = 0; i < packed.length; i++)
        bytes[i] = packed.charCodeAt(i);
    return bytes;
}

// Numbers of 7 bits a byte, the least significant first; the last byte is below 128.
function reader(bytes) {
    let at = 0;
    return () => {
        let value = 0, place = 1, byte;
        do {
            byte = bytes[at++];
            value += (byte & 127) * place;
            place *= 128;
        } while (byte & 128);
        return value;
    };
}

// The title, and an entry of the legend for each name and colour, its channels from 0 to 255.
function showTitle(title, legend) {
    document.title = document.getElementById("title").textContent = title;
    for (const [name, ...colour] of legend) {
        const entry = document.createElement("span"), swatch = document.createElement("i");
        swatch.style.background = `rgb(${colour.join(",")})`;
        entry.append(swatch, name);
        document.getElementById("legend").append(entry);
    }
}

// The view in degrees, which dragging and the wheel change; `steepest` is how far from level it may look.
function turnByHand(canvas, view, steepest, draw) {
    let from = null;
    canvas.addEventListener("pointerdown", event => {
        from = [event.clientX, event.clientY];
        canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointerup", () => { from = null; });
    canvas.addEventListener("pointermove", event => {
        if (!from)
            return;
        view.azimuth -= (event.clientX - from[0]) * 0.4;
        view.elevation += (event.clientY - from[1]) * 0.4;
        view.elevation = Math.min(steepest, Math.max(-steepest, view.elevation));
        from = [event.clientX, event.clientY];
        draw();
    });
    canvas.addEventListener("wheel", event => {
        event.preventDefault();
        view.zoom = Math.min(50, Math.max(0.1, view.zoom * Math.exp(-event.deltaY * 0.001)));
        draw();
    }, {passive: false});
}

