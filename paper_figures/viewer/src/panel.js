// The scene of one panel: the body (tets or rendered surface), its inverted tets and the skeleton, updated when the state changes.
import { distance_shade } from "./colours.js";
import { vertex_normals } from "./faces.js";
import { Body } from "./body.js";
import { Skeleton } from "./skeleton.js";
import { draws_surface } from "./state.js";

const ghost = [0.62, 0.66, 0.7];

export class Panel {
    constructor() {
        this.body = new Body();
        this.inverted = new Body();
        this.skeleton = new Skeleton();
        this.contents = [this.inverted.mesh, this.body.mesh, this.skeleton.group];
    }

    // mesh: { run, neighbours, outer, kept, faces }, see meshes.js
    update(mesh, label, shown, palette, ratio_shades) {
        const { run } = mesh, at = shown.at;
        const rendered = draws_surface(run, shown), codes = run.ratio_codes(label, at);
        this.choose_faces(mesh, rendered);
        this.points = run.points(label, at, rendered);
        this.body.move(this.points, vertex_normals(this.points, rendered ? run.surface.corners : mesh.outer));
        this.body.paint(this.colouring(run, label, shown, palette, ratio_shades, codes));
        this.body.look(shown.colour === "skin" ? 0.3 : 0.55, shown.colour === "inverted" ? 0.3 : 1);
        this.inverted.mesh.visible = shown.colour === "inverted";
        if (this.inverted.mesh.visible) this.show_inverted(mesh, run.positions(label, at), codes, palette);
        this.skeleton.group.visible = shown.bones;
        if (shown.bones) this.skeleton.pose(run.posed_bones(at));
    }

    choose_faces(mesh, rendered) {
        const chosen = rendered ? mesh.run.surface : mesh.faces;
        if (this.chosen === chosen) return;
        this.chosen = chosen;
        if (rendered) this.body.show_surface(chosen);
        else this.body.show_faces(mesh.run.corners, chosen, (face) => mesh.neighbours[face] < 0);
    }

    drawn_positions() {
        return this.body.drawn_positions(this.points.length / 3);
    }

    colouring(run, label, shown, palette, ratio_shades, codes) {
        if (shown.colour === "ratio") return (tet) => ratio_shades[codes[tet]];
        if (shown.colour === "inverted") return () => ghost;
        if (shown.colour === "skin") return () => palette.skin;
        if (!run.has_errors(label, shown.at)) return () => ghost;
        const errors = run.errors_mm(label, shown.at, draws_surface(run, shown)), most = run.largest_error_mm();
        return (_, vertex) => distance_shade(palette.error.shades, most, errors[vertex]);
    }

    // All four faces of each inverted tet that the cut keeps.
    show_inverted(mesh, positions, codes, palette) {
        const faces = [];
        codes.forEach((code, tet) => { if (code === 0 && mesh.kept[tet]) faces.push(4 * tet, 4 * tet + 1, 4 * tet + 2, 4 * tet + 3); });
        this.inverted.show_faces(mesh.run.corners, faces, () => false);
        this.inverted.move(positions, positions);
        this.inverted.paint(() => palette.inverted);
        this.inverted.look(0.6, 1);
    }
}
