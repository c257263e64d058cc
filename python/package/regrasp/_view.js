// The page of a plan in a frame of its own. Model: page (HTML), time (s), playing; both sides may change the last two.

function render({ model, el }) {
    const frame = document.createElement("iframe");
    frame.style.cssText = "width:100%;height:620px;border:0";
    frame.allow = "fullscreen";
    frame.srcdoc = model.get("page");
    el.append(frame);
    const page = () => frame.contentWindow?.regrasp;
    // What the page was last seen at: a time that came from it is not sent back.
    let seen = null;

    const lead = () => {
        const shown = page();
        if (!shown) return;
        if (model.get("time") !== seen) shown.seek(model.get("time"));
        if (model.get("playing") === shown.playing) return;
        if (model.get("playing")) shown.play();
        else shown.pause();
    };
    const follow = () => {
        const shown = page();
        if (!shown) return;
        if (seen === null) lead();
        if (shown.time === seen && shown.playing === model.get("playing")) return;
        seen = shown.time;
        model.set("time", seen);
        model.set("playing", shown.playing);
        model.save_changes();
    };
    model.on("change:time", lead);
    model.on("change:playing", lead);
    const timer = setInterval(follow, 100);
    return () => {
        clearInterval(timer);
        model.off("change:time", lead);
        model.off("change:playing", lead);
    };
}

export default { render };
