/* Commands that paint: dab, stroke, sculpt, project, shape, flood, ramp. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "brush/preset.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "field/ramp.h"
#include "field/select.h"
#include "field/scheme.h"
#include "field/scheme_list.h"
#include "field/shape_outline.h"
#include "surface/mesh_texels.h"

#include <math.h>

/* ---- The brush as commands: dab, stroke ---- */

static bool run_dab(WrSession *session, WrCall *call, WrError *err)
{
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrArg *at = wr_call_arg(call, "u,v");
    wr_brush_dab_on(&painting.ground, &painting.held.brush, at->numbers[0], at->numbers[1]);
    wr_painting_end(session, &painting);
    return true;
}

static WrSample sample_of(const void *ctx, int i)
{
    const WrArg *points = ctx;
    const double *row = points->numbers + (size_t)7 * (size_t)i;
    return (WrSample){ .u = row[0],
                       .v = row[1],
                       .pressure = points->counts[i] > 2 ? row[2] : 1,
                       .tilt_x = row[3],
                       .tilt_y = row[4],
                       .seconds = row[5],
                       .turn_deg = row[6] };
}

static bool run_stroke(WrSession *session, WrCall *call, WrError *err)
{
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrArg *points = wr_call_arg(call, "points");
    bool good = wr_session_draw(&painting, sample_of, points, points->rows, err);
    wr_painting_end(session, &painting);
    return good;
}

static const WrArgSpec args_dab[] = { { PLACE("u,v"), .also = "at", .type = WR_ARG_TUPLE,
                                        .components = 2, .low = -1e9, .high = 1e9,
                                        .help = "the centre; v up" },
                                      { 0 } };

static const WrComponent sample_parts[] = {
    { "u", -1e9, 1e9, false },        { "v", -1e9, 1e9, false },
    { "pressure", -1e9, 1e9, false }, { "tilt_x", -1e9, 1e9, false },
    { "tilt_y", -1e9, 1e9, false },   { "seconds", -1e9, 1e9, false },
    { "turn", -1e9, 1e9, false },
};

static const WrArgSpec args_stroke[] = {
    { .name = "points",
      .type = WR_ARG_LIST,
      .required = true,
      .components = 7,
      .parts = sample_parts,
      .counts = TUPLE_OF(2) | TUPLE_OF(3) | TUPLE_OF(5) | TUPLE_OF(6) | TUPLE_OF(7),
      .rows_low = 1,
      .rows_high = WR_POINTS_MAX,
      .shape = "u,v[,pressure[,tilt_x,tilt_y[,seconds[,turn]]]];...",
      .help = "the pen's samples in order; pressure is clamped to 0..1, tilt to -1..1; "
              "turn: degrees about the pen's axis" },
    { 0 }
};

/* ---- strokes on a mesh ---- */

static WrSample mesh_sample_of(const void *ctx, int i)
{
    const WrArg *points = ctx;
    const double *row = points->numbers + (size_t)8 * (size_t)i;
    return (WrSample){ .p = { row[0], row[1], row[2] },
                       .pressure = points->counts[i] > 3 ? row[3] : 1,
                       .tilt_x = row[4],
                       .tilt_y = row[5],
                       .seconds = row[6],
                       .turn_deg = row[7] };
}

static bool run_sculpt(WrSession *session, WrCall *call, WrError *err)
{
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrArg *points = wr_call_arg(call, "points");
    bool good = wr_session_draw(&painting, mesh_sample_of, points, points->rows, err);
    wr_painting_end(session, &painting);
    return good;
}

static const WrComponent mesh_sample_parts[] = {
    { "x", -WR_LENGTH_MAX, WR_LENGTH_MAX, false },
    { "y", -WR_LENGTH_MAX, WR_LENGTH_MAX, false },
    { "z", -WR_LENGTH_MAX, WR_LENGTH_MAX, false },
    { "pressure", -1e9, 1e9, false },
    { "tilt_x", -1e9, 1e9, false },
    { "tilt_y", -1e9, 1e9, false },
    { "seconds", -1e9, 1e9, false },
    { "turn", -1e9, 1e9, false },
};

/* By the bits of WrBrushGround.mirrors. */
static const char *const mirror_axes[] = { "none", "x", "y", "xy", "z", "xz", "yz", "xyz", NULL };

static const WrArgSpec args_sculpt[] = {
    { .name = "points",
      .type = WR_ARG_LIST,
      .required = true,
      .components = 8,
      .parts = mesh_sample_parts,
      .counts = TUPLE_OF(3) | TUPLE_OF(4) | TUPLE_OF(6) | TUPLE_OF(7) | TUPLE_OF(8),
      .rows_low = 1,
      .rows_high = WR_POINTS_MAX,
      .shape = "x,y,z[,pressure[,tilt_x,tilt_y[,seconds[,turn]]]];...",
      .help = "the pen's samples in order, in the mesh's own coordinates; each is moved to the "
              "nearest point of the surface" },
    { .name = "eye",
      .type = WR_ARG_TUPLE,
      .components = 3,
      .low = -WR_LENGTH_MAX,
      .high = WR_LENGTH_MAX,
      .shape = "x,y,z",
      .help = "viewpoint in the mesh's coordinates: faces turned away from it are not painted; "
              "left out, all faces are painted" },
    { .name = "mirror_axes",
      .type = WR_ARG_CHOICE,
      .words = mirror_axes,
      .fallback_text = "none",
      .help = "repeats the stroke mirrored across these axes of the mesh" },
    { .name = "mirror_at",
      .type = WR_ARG_TUPLE,
      .components = 3,
      .low = -WR_LENGTH_MAX,
      .high = WR_LENGTH_MAX,
      .shape = "x,y,z",
      .help = "point where the mirrors cross, in the mesh's coordinates; left out, 0,0,0 if that "
              "is inside the mesh's bounding sphere, else the mesh's centre" },
    { 0 }
};

/* ---- a layer as a slide on a mesh ---- */

static double slide_value(const void *ctx, double s, double t)
{
    double height;
    wr_field_sample(ctx, WR_SCHEME_BILINEAR, 1, &s, &t, &height, NULL, NULL);
    return height > 0.0 ? fmin(height, 1.0) : 0.0;
}

static WrVec3 vector_of(const WrCall *call, const char *name)
{
    const double *at = wr_call_arg(call, name)->numbers;
    return (WrVec3){ at[0], at[1], at[2] };
}

/* The picture has the table's proportions. */
static bool slide_of(const WrCall *call, const WrField *source, WrMeshSlide *slide, WrError *err)
{
    const double wide = 0.5 * wr_call_number(call, "width");
    const double high = wide * wr_field_height(source) / wr_field_width(source);
    *slide = (WrMeshSlide){ .eye = vector_of(call, "eye"),
                            .middle = vector_of(call, "at"),
                            .parallel = wr_call_choice(call, "parallel") == 1,
                            .value = slide_value,
                            .ctx = source };
    const WrVec3 none = { 0, 0, 0 }, line = v3_unit(v3_sub(slide->middle, slide->eye), none);
    const WrVec3 right = v3_unit(v3_cross(line, vector_of(call, "up")), none);
    if (!(v3_len(right) > 0.5))
        return wr_fail(err, "eye=, at= and up= define no view: eye and at must differ, and up must "
                            "not be parallel to the line between them");
    slide->right = v3_scale(right, wide);
    slide->up = v3_scale(v3_cross(right, line), high);
    return true;
}

/* NULL and an error: no memory, cancelled, or nothing of it is seen. */
static WrField *slide_cover(WrMeshTexels *mesh, const WrMeshSlide *slide, const WrField *like,
                            WrError *err)
{
    const int w = wr_field_width(like), h = wr_field_height(like);
    const size_t all = (size_t)w * (size_t)h;
    float *map = wr_try_alloc(all, sizeof *map, "a projection", err);
    WrField *cover = NULL;
    if (!map) return NULL;
    bool any = false;
    if (!wr_mesh_texels_slide(mesh, slide, map)) wr_fail(err, "cancelled");
    else cover = wr_field_new(w, h, wr_field_wrap_u(like), wr_field_wrap_v(like), 0, err);
    if (cover) wr_field_write(cover, 0, 0, w, h, map, (size_t)w);
    for (size_t i = 0; i < all && cover && !any; i++) any = map[i] > 0;
    wr_free(map);
    if (!cover || any) return cover;
    wr_field_free(cover);
    wr_fail(err,
            "nothing of the layer hits the mesh from eye=: move the projector, or enlarge width=");
    return NULL;
}

/* into=new: an empty layer above the projected one, which is hidden. */
static bool add_layer(WrDocument *document, int index, WrError *err)
{
    if (document->layer_count >= WR_LAYERS_MAX)
        return wr_fail(err, "a document has up to %d layers", WR_LAYERS_MAX);
    document->layers[index].visible = false;
    wr_document_insert(document, index + 1,
                       wr_layer_make("projected", document->layers[index].heights));
    document->active = index + 1;
    return true;
}

static bool run_project(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrPainting painting;
    WrMeshSlide slide;
    int index;
    if (!wr_session_find_layer(session, wr_call_arg(call, "LAYER")->text, &index, err) ||
        (wr_call_choice(call, "into") == 1 && !add_layer(document, index, err)) ||
        !wr_painting_begin(session, call, &painting, err))
        return false;
    const WrBrushGround *ground = &painting.ground;
    const WrLayer *from = &document->layers[index];
    WrField *source = wr_layer_holds(from)
                          ? wr_field_share(from->heights)
                          : wr_document_layer_alone(document, index, session->options.pool);
    WrField *cover = slide_of(call, source, &slide, err)
                         ? slide_cover(ground->mesh, &slide, ground->field, err)
                         : NULL;
    bool good = cover != NULL;
    if (good) {
        double x, y;
        const WrMeshSpot middle = wr_mesh_texels_nearest(ground->mesh, slide.middle);
        wr_mesh_texels_place(ground->mesh, &middle, &x, &y);
        painting.ground.progress = wr_progress_here();
        good = wr_brush_fill(ground, &painting.held.brush, cover, (x + 0.5) / wr_field_width(cover),
                             1.0 - (y + 0.5) / wr_field_height(cover), err);
    }
    wr_field_free(cover);
    wr_field_free(source);
    wr_painting_end(session, &painting);
    return good;
}

static const char *const project_targets[] = { "active", "new", NULL };

#define MESH_POINT(name_, help_)                                                                   \
    .name = name_, .type = WR_ARG_TUPLE, .components = 3, .low = -WR_LENGTH_MAX,                   \
    .high = WR_LENGTH_MAX, .shape = "x,y,z", .help = help_

static const WrArgSpec args_project[] = {
    { PLACE("LAYER"), .type = WR_ARG_LAYER,
      .help = "the layer that is projected: its heights, 0..1, are the coverage" },
    { MESH_POINT("eye", "position of the projector, in the mesh's coordinates"), .required = true },
    { MESH_POINT("at", "position of the layer's centre"), .required = true },
    { MESH_POINT("up", "the direction of the layer's upper side"), .fallback = NUMBERS(0, 1, 0) },
    { .name = "width",
      .type = WR_ARG_NUMBER,
      .required = true,
      .low = WR_LENGTH_MIN,
      .high = WR_LENGTH_MAX,
      .help = "width of the projected layer at at=, in the mesh's unit; its height follows from "
              "the table's proportions" },
    { .name = "parallel",
      .type = WR_ARG_CHOICE,
      .words = wr_off_on,
      .fallback_text = "off",
      .help = "on: parallel rays in the direction from eye to at" },
    { .name = "into",
      .type = WR_ARG_CHOICE,
      .words = project_targets,
      .fallback_text = "active",
      .help = "the active layer, or a new one above LAYER, which is then hidden" },
    PAINT_ARGS,
    { 0 }
};

/* ---- the rows ---- */

const WrCommand wr_command_dab = {
    .name = "dab",
    .kind = WR_CLASS_EDIT,
    .args = args_dab,
    .more = wr_args_brush,
    .run = run_dab,
    .help = "paint one dab",
    .details = "With tip= it is a stamp. Given arguments replace those of the preset.",
    .example = "dab 0.5,0.5 radius=40 strength=0.3"
};

const WrCommand wr_command_stroke = {
    .name = "stroke",
    .kind = WR_CLASS_EDIT,
    .args = args_stroke,
    .more = wr_args_brush,
    .run = run_stroke,
    .streams = true,
    .help = "paint a stroke along a path",
    .details =
        "The modes from raise to erode compute each texel from its height before the stroke and "
        "its largest coverage during the stroke, so a stroke that crosses itself does not double "
        "there; with flow= below 1, a preset or buildup=on the dabs add up instead. smooth, level, "
        "pinch and smear change the current heights, dab by dab. Consecutive samples are joined "
        "along the shorter way around the table. Given arguments replace those of the preset. "
        "Symmetry repeats the whole stroke: mirrored, rotated, or on a lattice over the cell.",
    .example = "stroke points=0.1,0.5;0.9,0.5,0.4 radius=12 mode=lower"
};

const WrCommand wr_command_project = {
    .name = "project",
    .kind = WR_CLASS_EDIT,
    .args = args_project,
    .run = run_project,
    .on_mesh = true,
    .help = "project a layer onto the object's mesh",
    .details =
        "Text, shapes, stamps and pictures of a layer are projected onto the visible faces of the "
        "mesh as by a slide projector, across the seams of (u,v), and change the active layer by "
        "mode= and strength=. Faces that are turned away or hidden by others do not change.",
    .example = "project lettering eye=0,0,5 at=0,0,1 width=1.5 strength=0.2 into=new"
};

const WrCommand wr_command_sculpt = {
    .name = "sculpt",
    .kind = WR_CLASS_EDIT,
    .args = args_sculpt,
    .more = wr_args_brush,
    .run = run_sculpt,
    .streams = true,
    .on_mesh = true,
    .help = "paint a stroke on the object's mesh",
    .details = "Like `stroke`, but on the surface: the radius is measured along the faces, so a "
               "dab continues across the seams of (u,v) and does not reach through a wall. The "
               "radius is in texels of the mean size of texels on the mesh. With tip= it lays a "
               "stamp on the surface. A texel that several places of the mesh share changes at all "
               "of them; a note reports it. clone copies from another place in the table. "
               "mirror_axes= repeats each dab on the other side, unless the mesh has no surface "
               "within the dab's radius there. mirror=, radial= and repeat= have no effect.",
    .example = "sculpt points=0,0,1;0.3,0,0.95,0.6 radius=12 eye=0,0,5"
};

/* ---- Shapes drawn with the brush: rectangles, ellipses, polygons, paths ---- */

#define OUTLINE_TOLERANCE 0.0625 /* texels between a curve and its chords, for outlines */

#define FILL_TOLERANCE (1.0 / 1024.0) /* the same limit for filled shapes, whose area is exact */

static WrSelectPoint point(const WrCall *call, const char *name)
{
    const double *numbers = wr_call_arg(call, name)->numbers;
    return (WrSelectPoint){ numbers[0], numbers[1] };
}

/* ---- the four shapes: outlines from a call ---- */

typedef bool Maker(const WrField *like, const WrCall *call, double tolerance, WrShapeOutline *out,
                   WrError *err);

static bool rectangle(const WrField *like, const WrCall *call, double tolerance,
                      WrShapeOutline *out, WrError *err)
{
    return wr_shape_outline_rectangle(like, point(call, "a"), point(call, "b"),
                                      wr_call_number(call, "corner"), wr_call_number(call, "turn"),
                                      tolerance, out, err);
}

static bool ellipse(const WrField *like, const WrCall *call, double tolerance, WrShapeOutline *out,
                    WrError *err)
{
    return wr_shape_outline_ellipse(like, point(call, "at"), point(call, "radii"),
                                    wr_call_number(call, "turn"), tolerance, out, err);
}

static WrSelectPoint *points_of(const WrArg *list)
{
    WrSelectPoint *points = wr_alloc((size_t)list->rows, sizeof *points);
    for (int i = 0; i < list->rows; i++)
        points[i] = (WrSelectPoint){ list->numbers[2 * i], list->numbers[2 * i + 1] };
    return points;
}

static bool polygon(const WrField *like, const WrCall *call, double tolerance, WrShapeOutline *out,
                    WrError *err)
{
    (void)like;
    (void)tolerance;
    const WrArg *list = wr_call_arg(call, "points");
    WrSelectPoint *points = points_of(list);
    bool good = wr_shape_outline_polygon(points, list->rows, out, err);
    wr_free(points);
    return good;
}

static bool path(const WrField *like, const WrCall *call, double tolerance, WrShapeOutline *out,
                 WrError *err)
{
    const WrArg *list = wr_call_arg(call, "points");
    WrSelectPoint *points = points_of(list);
    bool closed = wr_call_choice(call, "closed") == 1;
    bool good = wr_shape_outline_path(like, points, list->rows, closed, tolerance, out, err);
    wr_free(points);
    return good;
}

enum { SHAPE_RECTANGLE, SHAPE_ELLIPSE, SHAPE_POLYGON, SHAPE_PATH, SHAPE_FORMS };

WR_ROWS(makers);
static Maker *const makers[] = {
    [WR_ROW(SHAPE_RECTANGLE)] = rectangle,
    [WR_ROW(SHAPE_ELLIPSE)] = ellipse,
    [WR_ROW(SHAPE_POLYGON)] = polygon,
    [WR_ROW(SHAPE_PATH)] = path,
};
WR_ROWS_END(makers, SHAPE_FORMS);

/* ---- strokes along outlines ---- */

/* An outline as the samples of a stroke. */
typedef struct Trace {
    WR_ARRAY(WrSelectPoint) points;
    double width, height;
    double length; /* texels */
} Trace;

static double distance(const Trace *trace, WrSelectPoint a, WrSelectPoint b)
{
    double x = trace->width * (b.u - a.u), y = trace->height * (b.v - a.v);
    return sqrt(x * x + y * y);
}

/* Strokes join samples along the shorter way round a periodic table, so each step must be shorter than half of it. */
static void go(Trace *trace, WrSelectPoint to)
{
    WrSelectPoint from = trace->points.data[trace->points.count - 1];
    double u = fabs(to.u - from.u), v = fabs(to.v - from.v);
    int steps = (int)ceil(4.0 * (u > v ? u : v));
    trace->length += distance(trace, from, to);
    for (int i = 1; i < steps; i++) {
        double t = (double)i / steps;
        WrSelectPoint p = { from.u + t * (to.u - from.u), from.v + t * (to.v - from.v) };
        wr_array_push(&trace->points, p);
    }
    wr_array_push(&trace->points, to);
}

/* Remove up to `by` texels from the end; the outline never vanishes. */
static void shorten(Trace *trace, double by)
{
    while (trace->points.count >= 2) {
        WrSelectPoint *end = &trace->points.data[trace->points.count - 1];
        double step = distance(trace, end[-1], end[0]);
        if (step > by) {
            double t = by / step;
            end->u += t * (end[-1].u - end->u);
            end->v += t * (end[-1].v - end->v);
            return;
        }
        if (trace->points.count == 2) return;
        trace->points.count--;
        by -= step;
    }
}

/* Texels between the dabs of a preset. */
static double preset_step(const WrBrush *brush)
{
    static const char *const names[] = { "dabs_per_actual_radius", "dabs_per_basic_radius" };
    double dabs = 0.0;
    for (int i = 0; i < 2; i++) {
        int index = wr_preset_setting_find(names[i]);
        if (index >= 0) dabs += wr_preset_value(brush->preset, index);
    }
    return dabs > 0.0 ? brush->radius / dabs : 0.0;
}

static bool goes_by_dabs(const WrBrush *b)
{
    return b->tip || b->buildup || b->flow < 1.0 || b->aspect > 1.0 || b->jitter_place > 0.0 ||
           b->jitter_size > 0.0 || b->jitter_angle_deg > 0.0 || wr_brush_modes[b->mode].moves;
}

/* Spread the dabs of a closed outline evenly over its length and stop before the one that would coincide with the
   first, so that the start is not painted twice. */
static void close_evenly(Trace *trace, WrBrush *brush)
{
    if (brush->preset) {
        double step = preset_step(brush);
        shorten(trace, 0.5 * (step < trace->length ? step : trace->length));
        return;
    }
    if (!goes_by_dabs(brush) || !(brush->radius > 0.0) || !(trace->length > 0.0)) return;
    double spacing = brush->spacing > 0.0 ? brush->spacing : wr_brush_modes[brush->mode].spacing;
    if (spacing < 0.01) spacing = 0.01;
    double dabs = floor(trace->length / (spacing * brush->radius));
    if (dabs < 1.0) dabs = 1.0;
    double step = trace->length / dabs;
    brush->spacing = step / brush->radius;
    shorten(trace, 1e-3 * step);
}

static WrSample sample_at(const void *ctx, int i)
{
    const Trace *trace = ctx;
    return (
        WrSample){ .u = trace->points.data[i].u, .v = trace->points.data[i].v, .pressure = 1.0 };
}

static bool draw_outline(WrPainting *painting, const WrShapeOutline *figure, WrError *err)
{
    const WrField *field = painting->ground.field;
    Trace trace = { .width = wr_field_width(field), .height = wr_field_height(field) };
    bool good = true;
    wr_array_push(&trace.points, figure->points[0]);
    for (int i = 1; i < figure->count + figure->closed && good; i++) {
        go(&trace, figure->points[i % figure->count]);
        if (trace.points.count > WR_POINTS_MAX)
            good = wr_fail(err, "an outline of more than %d samples", WR_POINTS_MAX);
    }
    if (good && figure->closed) close_evenly(&trace, &painting->held.brush);
    good = good && wr_session_draw(painting, sample_at, &trace, trace.points.count, err);
    wr_array_free(&trace.points);
    return good;
}

/* ---- filled shapes ---- */

/* Points of one symmetry copy, shifted close to the table on periodic axes. */
static void move_points(const WrField *field, const WrShapeOutline *figure, const WrCopy *copy,
                        WrSelectPoint *out)
{
    double width = wr_field_width(field), height = wr_field_height(field), du = 0.0, dv = 0.0;
    for (int i = 0; i < figure->count; i++) {
        double x = width * figure->points[i].u - 0.5,
               y = height * (1.0 - figure->points[i].v) - 0.5;
        double u = (copy->a * x + copy->b * y + copy->dx + 0.5) / width;
        double v = 1.0 - (copy->c * x + copy->d * y + copy->dy + 0.5) / height;
        if (i == 0 && wr_field_wrap_u(field) == WR_WRAP_PERIODIC) du = floor(u);
        if (i == 0 && wr_field_wrap_v(field) == WR_WRAP_PERIODIC) dv = floor(v);
        out[i] = (WrSelectPoint){ u - du, v - dv };
    }
}

/* The union of all copies; NULL and an error when cancelled or out of range. */
static WrField *cover_copies(WrSession *session, const WrField *field, const WrShapeOutline *figure,
                             const WrCopy *copies, int count, WrError *err)
{
    WrSelectPoint *points = wr_alloc((size_t)figure->count, sizeof *points);
    WrField *cover = NULL;
    for (int i = 0; i < count; i++) {
        move_points(field, figure, &copies[i], points);
        WrField *one = wr_select_lasso(field, points, figure->count, session->options.pool, err);
        WrField *both =
            one ? wr_select_combine(cover, one, cover ? WR_SELECT_ADD : WR_SELECT_REPLACE, err)
                : NULL;
        wr_field_free(one);
        wr_field_free(cover);
        cover = both;
        if (cover && !wr_progress_report((double)i / count)) {
            wr_fail(err, "cancelled");
            wr_field_free(cover);
            cover = NULL;
        }
        if (!cover) break;
    }
    wr_free(points);
    return cover;
}

/* Coverage without rotation or mirror copies: rectangles and ellipses have exact formulas, better than polygons. */
static WrField *cover_plain(WrSession *session, const WrField *field, const WrCall *call,
                            const WrShapeOutline *figure, WrError *err)
{
    WrPool *pool = session->options.pool;
    Maker *maker = makers[call->form];
    bool straight =
        maker == rectangle || maker == ellipse ? wr_call_number(call, "turn") == 0.0 : false;
    if (straight && maker == ellipse) {
        WrSelectPoint m = point(call, "at"), r = point(call, "radii");
        WrSelectPoint a = { m.u - r.u, m.v - r.v }, b = { m.u + r.u, m.v + r.v };
        if (fabs(m.u) + r.u <= WR_SELECT_REACH && fabs(m.v) + r.v <= WR_SELECT_REACH)
            return wr_select_ellipse(field, a, b, pool, err);
    }
    if (straight && maker == rectangle && wr_call_number(call, "corner") == 0.0)
        return wr_select_rectangle(field, point(call, "a"), point(call, "b"), pool, err);
    return wr_select_lasso(field, figure->points, figure->count, pool, err);
}

static bool fill_inside(WrSession *session, const WrPainting *painting, const WrCall *call,
                        const WrShapeOutline *figure, WrError *err)
{
    const WrField *field = painting->ground.field;
    const WrBrush *brush = &painting->held.brush;
    WrCopy *copies = wr_alloc(WR_COPIES_MAX, sizeof *copies);
    int count = wr_symmetry_copies(&brush->symmetry, field, copies);
    WrField *cover = count > 1 ? cover_copies(session, field, figure, copies, count, err)
                               : cover_plain(session, field, call, figure, err);
    WrBrushGround ground = painting->ground;
    ground.progress = wr_progress_here();
    bool good = cover &&
                wr_brush_fill(&ground, brush, cover, figure->points[0].u, figure->points[0].v, err);
    wr_field_free(cover);
    wr_free(copies);
    return good;
}

/* ---- the command ---- */

/* Build the outline; the number of points depends on the required precision, and is limited for polygons. */
static bool make_figure(const WrField *like, const WrCall *call, bool fill, WrShapeOutline *figure,
                        WrError *err)
{
    double tolerance = fill ? FILL_TOLERANCE : OUTLINE_TOLERANCE;
    if (!makers[call->form](like, call, tolerance, figure, err)) return false;
    while (fill && figure->count > WR_SELECT_POINTS && tolerance < 0.1) {
        tolerance *= 4.0;
        wr_shape_outline_fini(figure);
        if (!makers[call->form](like, call, tolerance, figure, err)) return false;
    }
    return true;
}

static bool run_shape(WrSession *session, WrCall *call, WrError *err)
{
    WrPainting painting;
    WrShapeOutline figure = { 0 };
    bool fill = wr_call_choice(call, "paint") == 1;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    bool good = make_figure(painting.ground.field, call, fill, &figure, err);
    if (good)
        good = fill ? fill_inside(session, &painting, call, &figure, err)
                    : draw_outline(&painting, &figure, err);
    wr_shape_outline_fini(&figure);
    wr_painting_end(session, &painting);
    return good;
}

static const char *const paints[] = { "outline", "fill", NULL };

#define POINTS(low_, high_, help_)                                                                 \
    {                                                                                              \
        .name = "points", .type = WR_ARG_LIST, .required = true, .components = 2,                  \
        .shape = "u,v;...", .rows_low = low_, .rows_high = high_, .low = -WR_SELECT_REACH,         \
        .high = WR_SELECT_REACH, .help = help_                                                     \
    }

#define TURN                                                                                       \
    {                                                                                              \
        .name = "turn", .type = WR_ARG_NUMBER, .low = -360, .high = 360, .fallback = NUMBERS(0),   \
        .unit = "degrees", .help = "turns the shape anticlockwise about its centre"                \
    }

#define PAINT                                                                                      \
    {                                                                                              \
        .name = "paint", .type = WR_ARG_CHOICE, .words = paints, .fallback_text = "outline",       \
        .help = "draw the outline with the brush, or apply the mode to the inside"                 \
    }

WR_ROWS(shape_forms);
static const WrForm shape_forms[] = {
    [WR_ROW(SHAPE_RECTANGLE)] = { .name = "rectangle",
                                  .help = "rectangle between two corners",
                                  .args = { POINT("a", "a corner"),
                                            POINT("b", "the opposite corner"),
                                            { .name = "corner",
                                              .type = WR_ARG_NUMBER,
                                              .low = 0,
                                              .high = 1e9,
                                              .fallback = NUMBERS(0),
                                              .unit = "texels",
                                              .help = "radius of its corners, at most half the "
                                                      "shorter side" },
                                            TURN,
                                            PAINT } },
    [WR_ROW(SHAPE_ELLIPSE)] = { .name = "ellipse",
                                .help = "ellipse about a point",
                                .args = { { WR_ARG_MIDDLE, .also = "middle" },
                                          WR_ARG_RADII,
                                          TURN,
                                          PAINT } },
    [WR_ROW(
        SHAPE_POLYGON)] = { .name = "polygon",
                            .help = "closed polygon through points, filled by the even-odd rule",
                            .args = { POINTS(3, WR_SELECT_POINTS, "corners in order"), PAINT } },
    [WR_ROW(
        SHAPE_PATH)] = { .name = "path",
                         .help = "path of cubic Bezier curves",
                         .args = { POINTS(4, 3 * 4096 + 1,
                                          "the start, then for each curve two handles and its end"),
                                   { .name = "closed",
                                     .type = WR_ARG_CHOICE,
                                     .words = wr_off_on,
                                     .fallback_text = "off",
                                     .help = "on: a straight line closes the outline; a fill is "
                                             "always closed" },
                                   PAINT } },
};
WR_ROWS_END(shape_forms, SHAPE_FORMS);

WR_FORMS(form_shape, shape_forms)

/* ---- the row ---- */

const WrCommand wr_command_shape = {
    .name = "shape",
    .kind = WR_CLASS_EDIT,
    .form_word = "KIND",
    .form = form_shape,
    .more = wr_args_brush,
    .run = run_shape,
    .generates = true,
    .has_handles = true,
    .help = "draw or fill a rectangle, an ellipse, a polygon or a path",
    .details = "An outline is a stroke of the brush at full pressure; where it meets itself it "
               "does not double. A fill applies the mode at full coverage to the inside, with an "
               "antialiased edge; the brush's radius has no effect, and modes that move heights "
               "along the path cannot fill. Shapes wrap around periodic edges and keep their "
               "proportions in a cell that is not square.",
    .example = "shape ellipse at=0.5,0.5 radii=0.3,0.2 paint=fill strength=0.5"
};

/* ---- Flood fills and ramps ---- */

static bool run_flood(WrSession *session, WrCall *call, WrError *err)
{
    const WrDocument *document = session->state.document;
    const double *at = wr_call_arg(call, "u,v")->numbers;
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrProgress *progress = wr_progress_here();
    painting.ground.progress = progress;
    WrField *cover =
        wr_select_flood(wr_document_composite(document, session->options.pool), at[0], at[1],
                        wr_call_number(call, "tolerance"), wr_call_choice(call, "diagonal") == 1,
                        session->options.pool, progress, err);
    bool good =
        cover && wr_brush_fill(&painting.ground, &painting.held.brush, cover, at[0], at[1], err);
    wr_field_free(cover);
    wr_painting_end(session, &painting);
    return good;
}

/* ---- ramp ---- */

/* Blend the ramp into the heights. */
static bool join(WrField *heights, const WrField *ramp, WrBlend blend, const WrProgress *progress,
                 WrError *err)
{
    for (int ty = 0; ty < wr_field_tiles_v(heights); ty++) {
        if (wr_progress_cancelled(progress)) return wr_fail(err, "cancelled");
        for (int tx = 0; tx < wr_field_tiles_u(heights); tx++) {
            WrBlendTile tile = { .heights = wr_field_tile(ramp, tx, ty),
                                 .level = wr_field_level(ramp),
                                 .cover_level = 1.0f,
                                 .mask_level = 1.0f };
            float *below = wr_field_tile_write(heights, tx, ty);
            int columns = wr_field_width(heights) - tx * WR_TILE;
            int rows = wr_field_height(heights) - ty * WR_TILE;
            if (columns > WR_TILE) columns = WR_TILE;
            for (int y = 0; y < rows && y < WR_TILE; y++) {
                wr_blend_tile(blend, 1.0f, 0.0f, &tile, (size_t)columns, below + y * WR_TILE);
                if (tile.heights) tile.heights += WR_TILE;
            }
        }
    }
    return true;
}

static bool run_ramp(WrSession *session, WrCall *call, WrError *err)
{
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    const double *from = wr_call_arg(call, "from")->numbers, *to = wr_call_arg(call, "to")->numbers;
    WrRamp ramp = { .kind = (WrRampKind)call->form,
                    .from_u = from[0],
                    .from_v = from[1],
                    .to_u = to[0],
                    .to_v = to[1],
                    .low = wr_call_number(call, "low"),
                    .high = wr_call_number(call, "high"),
                    .fold = wr_call_choice(call, "fold") == 1 };
    const WrProgress *progress = wr_progress_here();
    WrField *made = wr_ramp_make(layer->heights, &ramp, session->options.pool, progress, err);
    if (!made) return false;
    WrBlend blend = wr_ramp_blends[wr_call_choice(call, "blend")];
    if (blend != WR_BLEND_REPLACE) {
        WrField *joined = wr_field_share(layer->heights);
        bool good = join(joined, made, blend, progress, err);
        wr_field_free(made);
        if (!good) {
            wr_field_free(joined);
            return false;
        }
        made = joined;
    }
    wr_session_put_heights(session, layer, made);
    return true;
}

static const char *ramp_blend(int i)
{
    return i >= 0 && i < WR_RAMP_BLENDS ? wr_blends[wr_ramp_blends[i]].name : NULL;
}

/* ---- flood, ramp ---- */

static const WrArgSpec args_flood[] = { WR_ARGS_FLOOD("the composite's heights"),
                                        PAINT_ARGS,
                                        { 0 } };

#define HEIGHT(name_, default_, help_)                                                             \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .low = -WR_BIG_HEIGHT, .high = WR_BIG_HEIGHT,        \
        .fallback = NUMBERS(default_), .help = help_                                               \
    }

#define RAMP_ARGS                                                                                  \
    POINT("from", "point of the low height"), POINT("to", "point of the high height"),             \
        HEIGHT("low", 0, "the height at from"), HEIGHT("high", 1, "the height at to"),             \
        { .name = "fold",                                                                          \
          .type = WR_ARG_CHOICE,                                                                   \
          .words = wr_off_on,                                                                      \
          .fallback_text = "off",                                                                  \
          .help = "on: the ramp falls again to its start, so that it has no steps" },              \
    {                                                                                              \
        .name = "blend", .type = WR_ARG_CHOICE, .choice = ramp_blend, .fallback_text = "replace",  \
        .help = "how the ramp is combined with the present heights"                                \
    }

/* In the order of WrRampKind. */
static const WrForm ramp_forms[] = {
    { .name = "linear",
      .help = "along a line: low before from, high after to. On periodic axes there is a step half "
              "a table away from the line's middle; with fold=on the ramp continues past to, "
              "around the table, and falls back to from instead, along u and v separately",
      .args = { RAMP_ARGS } },
    { .name = "radial",
      .help = "by the distance from from, across periodic edges: high beyond to, or with fold=on a "
              "ring that is low again at twice the distance. It has no steps",
      .args = { RAMP_ARGS } },
    { .name = "cone",
      .help =
          "by the angle about from, anticlockwise from the direction of to. There are steps in "
          "that direction and half a table away; with fold=on it rises for half a turn, falls for "
          "the other half, and is mirrored beyond a quarter of the table, so that it has no steps",
      .args = { RAMP_ARGS } },
};
_Static_assert(sizeof ramp_forms / sizeof *ramp_forms == WR_RAMP_KINDS, "one a kind");

static bool form_ramp(int i, WrForm *out)
{
    if (i >= WR_RAMP_KINDS) return false;
    *out = ramp_forms[i];
    return true;
}

/* ---- the rows ---- */

const WrCommand wr_command_flood = {
    .name = "flood",
    .kind = WR_CLASS_EDIT,
    .args = args_flood,
    .run = run_flood,
    .help = "fill a connected region of similar height",
    .details =
        "The region is found in the composite, continues across periodic edges, and has a hard "
        "edge. `select flood` selects it instead, so that it can be feathered or grown.",
    .example = "flood 0.5,0.5 tolerance=0.05 mode=to to=1 strength=10"
};

const WrCommand wr_command_ramp = { .name = "ramp",
                                    .kind = WR_CLASS_EDIT,
                                    .form_word = "KIND",
                                    .form = form_ramp,
                                    .run = run_ramp,
                                    .generates = true,
                                    .has_handles = true,
                                    .help = "fill with a ramp between two points",
                                    .example = "ramp linear from=0.1,0.5 to=0.6,0.5 fold=on" };
