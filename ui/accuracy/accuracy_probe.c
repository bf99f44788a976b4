#include "ui/accuracy/accuracy_probe.h"
#include "ui/accuracy/accuracy_work.h"

#include "base/text.h"
#include "base/vec.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "render/reference/reference.h"
#include "scene/texture_sample.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "surface/surface.h"

#include <math.h>
#include <stdio.h>

#define SAME_PLACE                                                                                 \
    1e-3 /* of the patch: at a smaller distance the pixel shows the requested position */

/* ---- visibility ---- */

/* Project a point of the object to a pixel of the view; false behind the eye. */
static bool project(const WrWork *work, WrVec3 p, double *x, double *y)
{
    WrPlacement at;
    if (!wr_scene_place(work->scene, work->turn_deg, (double)work->width / work->height, &at, NULL))
        return false;
    const WrVec3 from = v3_sub(wr_place_world(&at, p), at.eye);
    const double depth = v3_dot(from, at.forward);
    if (!(depth > 0)) return false;
    const double half = at.orthographic ? at.half_height : at.half_height * depth;
    const double scale = work->height / (2 * half);
    *x = work->width / 2.0 + scale * v3_dot(from, at.right);
    *y = work->height / 2.0 - scale * v3_dot(from, at.up);
    return true;
}

/* Quantities independent of a pixel, at u, v of the patch's first face. */
static void probe_at(const WrScene *scene, const WrField *field, double u, double v, WrProbe *out)
{
    *out = (WrProbe){ .hit = true, .u = u, .v = v };
    WrSurfacePoint *at = &out->at;
    wr_surface_at(&scene->shape, 0, u, v, at);
    wr_scene_slopes(scene, field, at, u, v, &out->f, &out->fu, &out->fv);
    out->d = wr_bump_d(at->n_unit, at->pu, at->pv, out->fu, out->fv);
    out->a = wr_bump_axis(at->pu, at->pv, out->fu, out->fv);
    WrVec3 perturbed[WR_BUMP_COUNT];
    for (int mode = 0; mode < WR_BUMP_COUNT; mode++)
        perturbed[mode] = wr_bump_unit_normal((WrBumpMode)mode, at->n, at->n_unit, at->pu, at->pv,
                                              at->n_u, at->n_v, out->f, out->fu, out->fv);
    out->perturbed = perturbed[scene->bump];
    out->perturbed_exact = perturbed[WR_BUMP_EXACT];
    out->tilt_deg = wr_bump_tilt_deg(at->n_unit, out->perturbed);
    out->dropped_deg = wr_bump_tilt_deg(out->perturbed_exact, perturbed[WR_BUMP_BLINN]);
}

/* Distance between two values of a parameter, the shorter way if it is periodic. */
static double apart(double a, double b)
{
    const double d = fabs(a - b);
    return d < 1 - d ? d : 1 - d;
}

/* Depth of a point of that object before the eye. */
static double depth_of(const WrWork *work, const WrScene *scene, WrVec3 p)
{
    WrPlacement at;
    if (!wr_scene_place(scene, work->turn_deg, (double)work->width / work->height, &at, NULL))
        return INFINITY;
    return v3_dot(v3_sub(wr_place_world(&at, p), at.eye), at.forward);
}

/* Probe the nearest object at that pixel; without a hit, the active one, which is not hit either. */
static bool probe_nearest(WrWork *work)
{
    const WrField *const *fields = wr_tables_fields(work->tables);
    double nearest = INFINITY;
    bool good = true;
    work->probe = (WrProbe){ 0 };
    for (int i = 0; good && i < wr_scene_object_count(work->scene); i++) {
        const double aspect = (double)work->width / work->height;
        if (!wr_scene_shows(work->scene, i, aspect)) continue;
        WrScene *part = wr_scene_object_alone(work->scene, i, aspect);
        const WrField *field = fields && fields[i] ? fields[i] : work->field;
        WrProbe seen;
        good = wr_reference_probe(field, part, work->width, work->height, work->turn_deg, work->x,
                                  work->y, &seen, &work->err);
        const double depth = good && seen.hit ? depth_of(work, part, seen.at.p) : INFINITY;
        if (depth < nearest) nearest = depth, work->probe = seen, work->object = i;
        wr_scene_free(part);
    }
    return good;
}

bool wr_accuracy_probe(WrWork *work)
{
    double x = work->x, y = work->y;
    WrProbe seen;
    const WrField *field = wr_tables_at_hand(work->tables, work->scene, work->field);
    work->seen = true;
    work->object = work->scene->chosen;
    if (!work->on_table && wr_scene_object_count(work->scene) > 1) return probe_nearest(work);
    if (!work->on_table)
        return wr_reference_probe(field, work->scene, work->width, work->height, work->turn_deg, x,
                                  y, &work->probe, &work->err);
    probe_at(work->scene, field, x, y, &work->probe);
    work->seen = project(work, work->probe.at.p, &x, &y) && x >= 0 && y >= 0 && x < work->width &&
                 y < work->height &&
                 wr_reference_probe(field, work->scene, work->width, work->height, work->turn_deg,
                                    x, y, &seen, NULL) &&
                 seen.hit && seen.face == 0 && apart(seen.u, work->probe.u) < SAME_PLACE &&
                 apart(seen.v, work->probe.v) < SAME_PLACE;
    if (work->seen) work->probe = seen;
    return true;
}

/* ---- output ---- */

static WrProbeRow one(const char *name, double value, const char *unit, const char *help)
{
    return (WrProbeRow){ name, unit, help, 1, { value } };
}

static WrProbeRow vector(const char *name, WrVec3 v, const char *help)
{
    return (WrProbeRow){ name, "", help, 3, { v.x, v.y, v.z } };
}

int wr_accuracy_probe_rows(const WrProbe *p, bool seen, WrProbeRow rows[WR_PROBE_ROWS])
{
    const WrSurfacePoint *at = &p->at;
    int n = 0;
    rows[n++] = (WrProbeRow){ "u, v", "", "Parameters of the patch", 2, { p->u, p->v } };
    rows[n++] = vector("P", at->p, "The point, object space, scene units");
    rows[n++] = vector("Pu", at->pu, "dP/du");
    rows[n++] = vector("Pv", at->pv, "dP/dv");
    rows[n++] = vector("N", at->n, "Pu x Pv, not unit");
    rows[n++] = one("|N|", at->n_len, "", "Its length");
    rows[n++] = one("F", p->f, "", "Height in scene units: bump height times the table's value");
    rows[n++] = one("Fu", p->fu, "", "dF/du, replication included");
    rows[n++] = one("Fv", p->fv, "", "dF/dv, replication included");
    rows[n++] = vector("D", p->d, "Fu (n x Pv) - Fv (n x Pu), n = N/|N|: the vector added to N");
    rows[n++] = vector("A", p->a, "Fv Pu - Fu Pv: the axis that the normal is turned about");
    rows[n++] = vector("n'", p->perturbed, "The turned normal, unit, by the scene's formula");
    rows[n++] = one("tilt", p->tilt_deg, "\xc2\xb0", "Angle between N and n'");
    rows[n++] = one("tan", at->n_len > 0 ? v3_len(p->d) / at->n_len : (double)NAN, "",
                    "|D| / |N|, the tangent of the paper's angle");
    rows[n++] =
        one("dropped", p->dropped_deg, "\xc2\xb0",
            "Between the paper's n' and the exact one: the effect of leaving out the terms in F");
    if (!seen) return n;
    rows[n++] = (WrProbeRow){ "dx, dy/dX",
                              "tx",
                              "The pixel's side to the right, in the table, texels",
                              2,
                              { p->footprint[0], p->footprint[1] } };
    rows[n++] = (WrProbeRow){ "dx, dy/dY",
                              "tx",
                              "The pixel's side down, in the table, texels",
                              2,
                              { p->footprint[2], p->footprint[3] } };
    rows[n++] =
        one("level", p->level, "", "Mip level: log2 of the footprint's longer side in texels");
    rows[n++] = (WrProbeRow){ "samples",
                              "",
                              "Along each side of the pixel, as the dials say",
                              2,
                              { p->samples, p->samples } };
    rows[n++] = (WrProbeRow){
        "RGB", "", "Linear intensity at this very point", 3, { p->rgb[0], p->rgb[1], p->rgb[2] }
    };
    return n;
}

char *wr_accuracy_probe_number(double value, char text[24])
{
    const double size = fabs(value);
    if (!isfinite(value))
        snprintf(text, 24, "%s", isnan(value) ? "\xe2\x80\x93" : value < 0 ? "-inf" : "inf");
    else if (value == rint(value) && size < 1e5) snprintf(text, 24, "%.0f", value + 0.0);
    else if (size < 5e-4 || size >= 1e5) snprintf(text, 24, "%.2e", value);
    else snprintf(text, 24, "%.*f", size < 10 ? 4 : size < 1000 ? 2 : 0, value);
    return text;
}

void wr_accuracy_probe_text(const WrProbe *probe, bool seen, WrText *text)
{
    WrProbeRow rows[WR_PROBE_ROWS];
    const int count = wr_accuracy_probe_rows(probe, seen, rows);
    for (int i = 0; i < count; i++) {
        wr_text_addf(text, "%-10s", rows[i].name);
        for (int k = 0; k < rows[i].count; k++) {
            wr_text_add(text, " ");
            wr_text_add_number(text, rows[i].value[k]);
        }
        wr_text_addf(text, "%s%s\n", rows[i].unit[0] ? " " : "", rows[i].unit);
    }
}
