/* SPDX-License-Identifier: MIT */
/* The search: every word must be in an entry; a name that begins with what was typed comes first. */
"use strict";
(() => {
    const field = document.getElementById("search"), found = document.getElementById("found");
    const top = document.body.dataset.top;
    const LIMIT = 30;
    let chosen = -1;

    const SHOWN = 300;
    /* Words that people use for what has another name here. */
    const SYNONYMS = {
        aabb: ["box"], angle: ["turn", "rotation"], batch: ["many poses"], bvh: ["tree"], ccd: ["time_of_impact"],
        collide: ["overlap"], collision: ["contact", "overlap"], concave: ["solid"], convexhull: ["polytope_create"],
        cspace: ["configuration space"], determinism: ["same bits"], distance: ["separation"], epa: ["penetration"],
        gjk: ["pair_distance"], heightmap: ["height_field", "height field"], hull: ["polytope"], intersect: ["overlap"],
        intersection: ["overlap"], manifold: ["contacts"], minkowski: ["sum"], numpy: ["python"], nonconvex: ["solid"],
        overlap: ["intersect"], penetration: ["depth"], quaternion: ["rotation", "quat"], raycast: ["ray", "cast"],
        serialize: ["snapshot", "save"], shapecast: ["cast"], sweep: ["cast"], terrain: ["height field", "mesh"],
        toi: ["time_of_impact"], transform: ["pose"], trigger: ["sensor"], triangle: ["trimesh"], trimesh: ["mesh"],
        world: ["scene"],
    };

    function meant(word) {
        return [word, ...(Object.hasOwn(SYNONYMS, word) ? SYNONYMS[word] : [])];
    }

    /* What is said is folded once. */
    const folded = ENTRIES.map(([title, , , text]) => ({name: title.toLowerCase(), text: text.toLowerCase()}));

    function score({name, text}, query, words) {
        if (name === query)
            return 9;
        if (name.startsWith(query))
            return 8;
        if (name.includes(query))
            return 7;
        if (words.every(word => name.includes(word[0])))
            return 6;
        if (words.every(word => word.some(other => name.includes(other))))
            return 5;
        if (text.includes(query))
            return text.indexOf(query) < SHOWN ? 4 : 3;
        const both = name + " " + text;
        if (words.every(word => both.includes(word[0])))
            return 2;
        return words.every(word => word.some(other => both.includes(other))) ? 1 : 0;
    }

    function search(query) {
        const words = query.split(/\s+/).map(meant), joined = query.replace(/[\s-]+/g, "");
        // "ray cast" is a word of its own as well
        const asked = [words, ...(joined !== query && Object.hasOwn(SYNONYMS, joined) ? [[meant(joined)]] : [])];
        return ENTRIES.map((entry, i) => ({entry, points: Math.max(...asked.map(w => score(folded[i], query, w)))}))
            .filter(hit => hit.points > 0)
            .sort((a, b) => b.points - a.points || a.entry[0].length - b.entry[0].length).slice(0, LIMIT);
    }

    function line([title, address, kind, text]) {
        const [item, link, more] = ["li", "a", "small"].map(name => document.createElement(name));
        link.href = top + address;
        link.append(title);
        more.append(kind + (text ? ": " + text.slice(0, SHOWN) : ""));
        link.append(more);
        item.append(link);
        return item;
    }

    function show() {
        const query = field.value.trim().toLowerCase();
        chosen = -1;
        found.hidden = !query;
        found.replaceChildren(...(query ? search(query).map(hit => line(hit.entry)) : []));
        if (query && !found.children.length) {
            const none = document.createElement("p");
            none.append("Nothing found.");
            found.append(none);
        }
    }

    function choose(step) {
        const items = [...found.querySelectorAll("li")];
        if (!items.length)
            return;
        chosen = (chosen + step + items.length) % items.length;
        items.forEach((item, i) => item.classList.toggle("chosen", i === chosen));
        items[chosen].scrollIntoView({block: "nearest"});
    }

    field.addEventListener("input", show);
    field.addEventListener("keydown", event => {
        const moves = {ArrowDown: 1, ArrowUp: -1};
        if (event.key in moves) {
            choose(moves[event.key]);
            event.preventDefault();
        } else if (event.key === "Enter") {
            const link = found.querySelector(chosen < 0 ? "li a" : ".chosen a");
            if (link)
                link.click();
        } else if (event.key === "Escape") {
            field.value = "";
            show();
        }
    });
    found.addEventListener("click", () => { found.hidden = true; });
    document.addEventListener("keydown", event => {
        if (event.key === "/" && document.activeElement !== field) {
            field.focus();
            event.preventDefault();
        }
    });
    document.addEventListener("click", event => {
        if (!found.contains(event.target) && event.target !== field)
            found.hidden = true;
    });
})();
