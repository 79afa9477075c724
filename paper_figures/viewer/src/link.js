// A pose as text in the address:
// #run=human_jump&frame=12&colour=error&panels=lbs,dqs,pbs,nh_p1&surface=rendered&cut=x,0.1,below&bones=1&claim=C02

export const colourings = ["skin", "ratio", "error", "inverted"];

// The pose that the address states; null if it is not an address of the viewer.
export function pose_of(hash) {
    const words = new URLSearchParams(hash.replace(/^#/, ""));
    if (!words.has("run") && !words.has("claim")) return null;
    const pose = {};
    if (words.has("run")) pose.run = words.get("run");
    if (/^\d+$/.test(words.get("frame") ?? "")) pose.frame = Number(words.get("frame"));
    if (colourings.includes(words.get("colour"))) pose.colour = words.get("colour");
    if (words.get("panels")) pose.panels = words.get("panels").split(",");
    if (words.has("surface")) pose.rendered = words.get("surface") === "rendered";
    if (words.has("cut")) pose.cut = cut_of(words.get("cut"));
    if (words.has("bones")) pose.bones = words.get("bones") === "1";
    if (words.get("claim")) pose.claim = words.get("claim");
    return pose;
}

export function hash_of(pose) {
    const words = [`run=${pose.run}`, `frame=${pose.frame}`, `colour=${pose.colour}`, `panels=${pose.panels.join(",")}`];
    if (pose.cut) words.push(`cut=${pose.cut.axis},${Number(pose.cut.at_m.toFixed(4))},${pose.cut.above ? "above" : "below"}`);
    if (pose.rendered) words.push("surface=rendered");
    if (pose.bones) words.push("bones=1");
    if (pose.claim) words.push(`claim=${encodeURIComponent(pose.claim)}`);
    return `#${words.join("&")}`;
}

function cut_of(text) {
    const [axis, at_m, side] = text.split(",");
    return /^[xyz]$/.test(axis) && Number.isFinite(Number(at_m)) ? { axis, at_m: Number(at_m), above: side === "above" } : null;
}
