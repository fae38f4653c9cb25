/* SPDX-License-Identifier: MIT */
/* The search: every word must be in an entry; a name that begins with what was typed comes first. */
"use strict";
(() => {
    const field = document.getElementById("search"), found = document.getElementById("found");
    const top = document.body.dataset.top;
    const LIMIT = 30;
    let chosen = -1;

    function score([title, , , text], query, words) {
        const name = title.toLowerCase(), all = name + " " + text.toLowerCase();
        if (!words.every(word => all.includes(word)))
            return 0;
        if (name === query)
            return 5;
        return name.startsWith(query) ? 4 : name.includes(query) ? 3 : words.every(word => name.includes(word)) ? 2 : 1;
    }

    function search(query) {
        const words = query.split(/\s+/);
        return ENTRIES.map(entry => ({entry, points: score(entry, query, words)})).filter(hit => hit.points > 0)
            .sort((a, b) => b.points - a.points || a.entry[0].length - b.entry[0].length).slice(0, LIMIT);
    }

    function line([title, address, kind, text]) {
        const [item, link, more] = ["li", "a", "small"].map(name => document.createElement(name));
        link.href = top + address;
        link.append(title);
        more.append(kind + (text ? ": " + text : ""));
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
