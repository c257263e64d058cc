// Brings the modules of this page to life: each becomes a blob that the next ones import. A page opened from a file may load nothing else.
(function () {
    "use strict";
    const urls = new Map();
    const named = /(\bfrom\s*|^import\s*)(["'])([^"'\n]+)\2/gm;
    const placed = (whole, before, quote, name) => (urls.has(name) ? `${before}"${urls.get(name)}"` : whole);
    let last = "";
    for (const script of document.querySelectorAll("script[data-module]")) {
        const name = script.dataset.module;
        const text = script.textContent.replace(named, placed);
        last = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
        urls.set(name, last);
        urls.set("./" + name, last);
    }
    import(last).catch((error) => {
        const problem = document.getElementById("problem");
        problem.hidden = false;
        problem.textContent = `This page cannot be shown: ${error.message}`;
        console.error(error);
    });
})();
