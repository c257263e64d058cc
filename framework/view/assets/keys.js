// The keys of a plan's page.

/** Speeds that the keys and the menu offer. */
export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];

/** What each key does: keys, what it says in the help, action. */
export function playKeys(app) {
    const { player } = app;
    const faster = (step) => () => {
        const place = Math.min(Math.max(SPEEDS.indexOf(player.speed) + step, 0), SPEEDS.length - 1);
        player.setSpeed(SPEEDS[place]);
    };
    return [
        [[" ", "k"], "Play or pause", () => player.togglePlay()],
        [["ArrowLeft"], "To the start of the segment, then of the one before", () => player.stepSegment(-1)],
        [["ArrowRight"], "To the end of the segment", () => player.stepSegment(1)],
        [[","], "One state back", () => player.stepState(-1)],
        [["."], "One state on", () => player.stepState(1)],
        [["Home"], "To the beginning", () => player.seek(player.begin)],
        [["End"], "To the end", () => player.seek(player.end)],
        [["-", "ArrowDown"], "Slower", faster(-1)],
        [["+", "=", "ArrowUp"], "Faster", faster(1)],
        [["d"], "Dark or light", () => app.theme.flip()],
        [["?", "h"], "This help", () => document.getElementById("help").showModal()],
    ];
}
