#include "export/export.h"

#include "base/error.h"
#include "field/scheme_list.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/object_tables.h"
#include "export/contact_sheet.h"
#include "export/job.h"
#include "export/preview.h"
#include "export/mip_files.h"
#include "export/cell_layout.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/scheme.h"
#include "image/image.h"
#include "image/sidecar.h"
#include "scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

WrExportOptions wr_export_default(void)
{
    return (WrExportOptions){ .range = WR_EXPORT_RANGE_AUTO,
                              .low = 0.0,
                              .high = 1.0,
                              .padding = 8,
                              .strength = 1.0,
                              .scheme = -1,
                              .filter = WR_RESIZE_LANCZOS3,
                              .margin = 4,
                              .lines_u = 64,
                              .lines_v = 64,
                              .turn_deg = 30.0,
                              .tilt_deg = 35.0,
                              .contact_tile = WR_CONTACT_TILE,
                              .drawing_w = 1024,
                              .drawing_h = 768,
                              .pen = 1.0,
                              .at = 0.5,
                              .grid = 8,
                              .solid_error = 0.05,
                              .solid_most = 4000000,
                              .directions = 16,
                              .toward = 0,
                              .radius = 8,
                              .box = 9,
                              .scale = NAN,
                              .mask_low = NAN,
                              .mask_high = NAN,
                              .threshold = 0.2,
                              .grain = 32 };
}

/* ---- functions shared by the kinds ---- */

double wr_export_last_code(const WrExportJob *job)
{
    return job->options.depth == 8 ? 255.0 : 65535.0;
}

/* Without a border, samples are texel centres: v = 1 - (y + 1/2) / h. With one, samples are the cell's corners and edges, (h
   + 1) of them, so that adjacent tiles of a terrain share their border samples; on a periodic axis the last equals the first,
   bit for bit. */
double wr_export_row_v(const WrExportJob *job, int y)
{
    if (!job->options.border) return 1.0 - (y + 0.5) / job->height;
    const int h = job->height - 1;
    const bool ring = wr_field_wrap_v(job->field) == WR_WRAP_PERIODIC;
    return 1.0 - (double)(ring ? y % h : y) / h;
}

/* Dither offset between -1/2 and 1/2, both excluded: the additive sequence of the plastic number over the
   texels, whose values are spread evenly over every small neighbourhood, so that no clumps are visible. The constants are
   2^32 / g, 2^32 / g^2 with the root g = 1.3247 of g^3 = g + 1 (Roberts' R2 sequence); channels are shifted by the golden
   ratio, so that their patterns do not coincide. */
static double dither(WrExportTexel at)
{
    uint32_t phase = (uint32_t)at.column * 0xc13fa9a9U + (uint32_t)at.row * 0x91e10da5U +
                     (uint32_t)at.channel * 0x9e3779b9U;
    return (phase + 0.5) * 0x1p-32 - 0.5;
}

void wr_export_store_code(const WrExportJob *job, void *out, size_t i, double x, int zero,
                          WrExportTexel at)
{
    double last = wr_export_last_code(job);
    if (job->options.dither) x += dither(at);
    double code = zero + round(x);
    code = code < 0.0 ? 0.0 : code > last ? last : code;
    if (job->options.depth == 8) ((uint8_t *)out)[i] = (uint8_t)code;
    else ((uint16_t *)out)[i] = (uint16_t)code;
}

typedef struct Run {
    WrExportJob *job;
    int y, rows;
    WrExportPiece piece;
    void *ctx;
} Run;

static void run_piece(int index, int worker, void *ctx)
{
    (void)worker;
    const Run *run = ctx;
    int first = index * WR_EXPORT_PIECE_ROWS, left = run->rows - first;
    run->piece(run->job, run->y + first, left < WR_EXPORT_PIECE_ROWS ? left : WR_EXPORT_PIECE_ROWS,
               run->ctx);
}

void wr_export_run(WrExportJob *job, int y, int rows, WrExportPiece piece, void *ctx)
{
    Run run = { job, y, rows, piece, ctx };
    wr_pool_run(job->pool, (rows + WR_EXPORT_PIECE_ROWS - 1) / WR_EXPORT_PIECE_ROWS, run_piece,
                &run);
}

WrText *wr_export_attribute(WrExportJob *job, const char *name)
{
    WR_ASSERT(job->attribute_count < WR_EXPORT_ATTRIBUTES);
    job->attribute_names[job->attribute_count] = name;
    return &job->attribute_texts[job->attribute_count++];
}

void wr_export_describe_slopes(WrExportJob *job)
{
    wr_text_add(wr_export_attribute(job, "wrinkle:scheme"), wr_schemes[job->options.scheme].name);
}

/* ---- one export ---- */

/* Settings of raw files of numbers: 16 bits or floats. */
static bool settle_numbers(const WrExportKind *kind, const char *path, WrExportOptions *options,
                           WrError *err)
{
    char ending[16];
    wr_path_ending(path, ending);
    const int named = strcmp(ending, "r16") == 0 ? 16 : strcmp(ending, "r32") == 0 ? 32 : 0;
    if (options->depth == 0) options->depth = named ? named : kind->floats ? 32 : 16;
    if (options->depth == 8 || (named && options->depth != named))
        return wr_fail(err, "%s: depth=%d: .r16 stores 16 bits, .r32 floats, .raw either", path,
                       options->depth);
    return true;
}

static bool settle_options(const WrExportKind *kind, int channels, const WrScene *scene,
                           const char *path, WrExportOptions *options, WrError *err)
{
    char ending[16];
    if (kind->ending && strcmp(wr_path_ending(path, ending), kind->ending) != 0)
        return wr_fail(err, "%s: %s files end in .%s", path, kind->name, kind->ending);
    if (kind->on_surface && !kind->make && !wr_export_object_check(scene, err)) return false;
    if (kind->write) return true; /* it handles the depth itself */
    if (wr_is_raw_path(path)) {
        if (!settle_numbers(kind, path, options, err)) return false;
    } else if (options->depth == 0) {
        WrPixelType type;
        if (!wr_image_deepest(path, &type, err)) return false;
        options->depth = type == WR_PIXEL_U8 ? 8 : type == WR_PIXEL_U16 ? 16 : 32;
    }
    if (options->depth == 16 && strcmp(wr_path_ending(path, ending), "exr") == 0)
        options->half = true, options->depth = 32;
    if (channels > 4 && wr_is_raw_path(path))
        return wr_fail(err, "%s: %d channels: raw files store up to 4", path, channels);
    if (channels > 4 && options->depth != 32)
        return wr_fail(err,
                       "%s of %d directions are floats, which %s cannot store: use exr or tiff",
                       kind->name, channels, path);
    if (kind->floats && options->depth != 32)
        return wr_fail(err, "%s are floats, which %s cannot store: use exr or tiff", kind->name,
                       path);
    if (options->depth != 8 && options->depth != 16 && options->depth != 32)
        return wr_fail(err, "depth %d: must be 8, 16 or 32", options->depth);
    if (!wr_is_raw_path(path) &&
        !wr_image_can_write(path, wr_export_pixels(options->depth), channels, true, err))
        return false;
    if (options->dither && options->depth != 8)
        return wr_fail(err, "dither needs 8 bits per channel; this file has %d (use depth=8)",
                       options->depth);
    if (options->range == WR_EXPORT_RANGE_GIVEN &&
        !(options->low < options->high && isfinite(options->high - options->low)))
        return wr_fail(err, "range %g,%g: LOW must be below HIGH, both finite", options->low,
                       options->high);
    if (options->cell_w == 0.0) options->cell_w = scene->cell.w;
    if (options->cell_h == 0.0) options->cell_h = scene->cell.h;
    if (!(options->cell_w > 0.0) || !(options->cell_h > 0.0) || !isfinite(options->cell_w) ||
        !isfinite(options->cell_h))
        return wr_fail(err, "cell %g,%g: both sizes must be above 0", options->cell_w,
                       options->cell_h);
    if (options->border && options->atlas)
        return wr_fail(err, "border=on is for one cell, not for an atlas");
    if (options->scheme < 0) options->scheme = (int)scene->scheme;
    if (options->scheme >= WR_SCHEME_COUNT)
        return wr_fail(err, "scheme %d: must be 0..%d", options->scheme, WR_SCHEME_COUNT - 1);
    return true;
}

/* Replaces the composite by the table of the requested object, for solids and models of the active one; the caller frees
   the tables. */
static bool take_object(WrExportJob *job, const WrDocument *document, WrTables **tables,
                        WrError *err)
{
    const char *name = job->options.object;
    const bool body = job->kind->solid || job->kind->write == wr_export_glb_write;
    if (!name && !body) return true;
    const int index = name ? wr_scene_object_find(document->scene, name) : document->scene->chosen;
    if (index < 0)
        return wr_fail(err, "object '%.60s': the scene has none of that name", job->options.object);
    *tables = wr_document_tables(document, document->scene, NULL, job->pool);
    const WrField *own = *tables ? wr_tables_fields(*tables)[index] : NULL;
    if (own) job->field = own;
    job->scene = wr_scene_object(document->scene, index);
    if (job->object > 0) job->object = index + 1;
    return true;
}

/* The scene with its height in the unit of the cell's size. */
static WrScene *in_unit(const WrScene *scene)
{
    WrScene *own = wr_scene_clone(scene);
    own->height = wr_scene_relief(scene);
    return own;
}

/* Normals: default axes of the channels. */
static void settle_axes(const WrExportKind *kind, int axes[3])
{
    if (axes[0] != 0 || kind->green == 0.0) return;
    axes[0] = 1;
    axes[1] = kind->green < 0.0 ? -2 : 2;
    axes[2] = 3;
}

static const char *convention_of(const WrExportKind *kind, const int axes[3])
{
    char text[7];
    if (kind->green == 0.0) return NULL;
    if (kind->on_surface && !kind->make) return "along the object's axes";
    wr_export_axes_text(axes, text);
    if (strcmp(text, "+x+y+z") == 0) return "+Y (green up)";
    return strcmp(text, "+x-y+z") == 0 ? "-Y (green down)" : "axes of its own";
}

/* Sets the sampling positions of the table, or of its arrangement. */
static void set_grid(WrExportJob *job)
{
    const bool sized = job->options.map_w > 0;
    const int w = sized ? job->options.map_w : wr_field_width(job->field);
    const int h = sized ? job->options.map_h : wr_field_height(job->field);
    const bool border = job->options.border, ring = wr_field_wrap_u(job->field) == WR_WRAP_PERIODIC;
    job->width = w + border;
    job->height = h + border;
    wr_free(job->u);
    job->u = wr_alloc((size_t)job->width, sizeof *job->u);
    for (int i = 0; i < job->width; i++)
        job->u[i] = !border ? (i + 0.5) / w : (double)(ring ? i % w : i) / w;
}

static bool write_one(WrExportJob *job, const char *path, WrError *err)
{
    set_grid(job);
    job->report = (WrExportReport){ .width = job->width,
                                    .height = job->height,
                                    .zero_code = -1,
                                    .channels = job->channels,
                                    .convention = convention_of(job->kind, job->options.axes),
                                    .depth = job->options.depth,
                                    .half = job->options.half };
    if (job->kind->ending || job->kind->on_surface) {
        job->report.object = job->object;
        job->report.objects = job->objects;
        snprintf(job->report.object_name, sizeof job->report.object_name, "%s",
                 job->scene->name ? job->scene->name : "");
    }
    job->report.seam = wr_export_certify_seam(job);
    if (job->values) return job->sizes_only || wr_export_fill_values(job, err);
    return job->picture       ? wr_export_fill_preview(job, err)
           : job->kind->write ? job->kind->write(job, path, err)
                              : wr_export_write(job, path, err);
}

/* Fixes the range of codes, so that it is equal on all levels. */
static void keep_codes(WrExportJob *job)
{
    const WrExportReport *report = &job->report;
    WrExportOptions *o = &job->options;
    if (!report->ranged) return;
    o->full = o->amplitude = report->amplitude;
    if (report->zero_code >= 0) return;
    o->range = WR_EXPORT_RANGE_GIVEN;
    o->low = report->code_low, o->high = report->code_high;
}

/* Writes the further mip levels, each from means of the heights of the level before. A normal map's own codes are not
   averaged: the length of a mean of normals shrinks where the relief is rough. */
static bool write_levels(WrExportJob *job, const char *path, WrError *err)
{
    const WrExportReport report = job->report;
    const WrField *first = job->field;
    WrField *field = NULL;
    keep_codes(job);
    WrText name = { 0 };
    bool good = true;
    for (int k = 1; good && wr_field_width(job->field) * wr_field_height(job->field) > 1; k++) {
        WrField *half = wr_export_half(job, job->field, err);
        wr_field_free(field);
        job->field = field = half;
        wr_export_level_name(path, k, &name);
        good = half && write_one(job, wr_text_get(&name), err);
    }
    wr_field_free(field);
    wr_text_fini(&name);
    job->field = first;
    job->report = report;
    return good;
}

/* All files of an export are replaced together, unless they already belong to a larger group. */
static bool write_files(WrExportJob *job, const char *path, WrError *err)
{
    WrFileGroup *group = wr_file_group_is_open() ? NULL : wr_file_group_begin();
    if (!write_one(job, path, err) || (job->options.mips && !write_levels(job, path, err))) {
        wr_file_group_abort(group);
        return false;
    }
    return !group || wr_file_group_commit(group, err);
}

static bool run_job(WrExportJob *job, const char *path, WrError *err)
{
    job->channels = job->kind->channels;
    if (job->kind->count_channels)
        job->channels = job->kind->count_channels(job, job->channel_names);
    bool good = settle_options(job->kind, job->channels, job->scene, path, &job->options, err);
    if (!good) return false;
    settle_axes(job->kind, job->options.axes);
    job->numbers = wr_is_raw_path(path);
    job->sidecar = job->options.sidecar == WR_EXPORT_SIDECAR_ON ||
                   (job->options.sidecar == WR_EXPORT_SIDECAR_LEFT_OUT && job->numbers);
    job->analytic = job->scene->analytic.kind != WR_ANALYTIC_OFF;
    set_grid(job);
    job->cell = job->field;
    WrField *sheet = wr_export_build_table(job, &good, err);
    if (sheet) job->field = sheet, job->analytic = false;
    good = good && (!job->picture && !job->values && (job->sidecar || job->options.mips)
                        ? write_files(job, path, err)
                        : write_one(job, path, err));
    for (int i = 0; i < job->attribute_count; i++) wr_text_fini(&job->attribute_texts[i]);
    wr_field_free(sheet);
    wr_free(job->u);
    wr_free(job->map);
    return good;
}

static bool run_scaled(WrExportJob *job, const char *path, WrError *err)
{
    WrScene *scaled = NULL;
    if (!job->kind->write && !job->kind->on_surface) job->scene = scaled = in_unit(job->scene);
    const bool ok = run_job(job, path, err);
    wr_scene_free(scaled);
    return ok;
}

/* Exports the document, or the object that the options name. */
static bool run_on(WrExportJob *job, const WrDocument *document, const char *path, WrError *err)
{
    WrTables *tables = NULL;
    wr_filters_forget();
    job->field = wr_document_field(document);
    job->scene = document->scene;
    job->object = document->scene->chosen + 1;
    job->objects = wr_scene_object_count(document->scene);
    if (job->objects == 1) job->object = job->objects = 0;
    const bool ok = take_object(job, document, &tables, err) && wr_filters_carried(err) &&
                    run_scaled(job, path, err);
    wr_tables_free(tables);
    return ok;
}

/* No export replaces the file that a mesh was read from. */
static bool check_target(const WrScene *scene, const char *path, WrError *err)
{
    const WrFileIdentity target = wr_file_identity(path);
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const char *name = wr_scene_object(scene, i)->triangles_path;
        const WrFileIdentity file = name && *name ? wr_file_identity(name) : (WrFileIdentity){ 0 };
        if (target.there && file.there && file.device == target.device &&
            file.inode == target.inode)
            return wr_fail(err, "%s: is the file that the mesh was read from: choose another name",
                           path);
    }
    return true;
}

bool wr_export(const WrExportKind *kind, const WrDocument *document, const WrExportOptions *options,
               WrPool *pool, const char *path, WrExportReport *report, WrError *err)
{
    WrExportJob job = { .kind = kind, .options = *options, .pool = pool };
    bool ok = check_target(document->scene, path, err) && run_on(&job, document, path, err);
    if (ok && report) *report = job.report;
    return ok;
}

/* A file name that fits the content of a picture; the depth goes into the job. */
static const char *picture_path(WrExportJob *job)
{
    job->options.depth = job->kind->floats ? 32 : 8;
    job->options.dither = false;
    return job->kind->floats ? "x.exr" : "x.png";
}

bool wr_export_preview(const WrExportKind *kind, const WrDocument *document,
                       const WrExportOptions *options, WrPool *pool, WrExportPreview *picture,
                       WrError *err)
{
    *picture = (WrExportPreview){ 0 };
    if (kind->write) return wr_fail(err, "%s: no picture of the table", kind->label);
    WrExportJob job = { .kind = kind, .options = *options, .pool = pool, .picture = picture };
    bool ok = run_on(&job, document, picture_path(&job), err);
    picture->report = job.report;
    return ok;
}

bool wr_export_values(const WrExportKind *kind, const WrDocument *document,
                      const WrExportOptions *options, bool sizes_only, WrPool *pool,
                      WrExportValues *values, WrError *err)
{
    *values = (WrExportValues){ 0 };
    if (kind->write) return wr_fail(err, "%s: no picture of the table", kind->label);
    WrExportJob job = {
        .kind = kind, .options = *options, .pool = pool, .values = values, .sizes_only = sizes_only
    };
    const bool floats = kind->floats || options->depth == 0 || options->depth == 32;
    if (options->depth == 0) job.options.depth = 32;
    if (!run_on(&job, document, floats ? "memory.exr" : "memory.png", err)) return false;
    values->width = job.report.width;
    values->height = job.report.height;
    values->channels = job.channels;
    values->depth = job.options.depth;
    values->report = job.report;
    for (int i = 0; i < job.channels; i++)
        snprintf(values->names[i], WR_EXPORT_NAME, "%s",
                 kind->channel_names ? kind->channel_names[i] : job.channel_names[i]);
    return true;
}

bool wr_export_preview_like(const WrExportJob *like, const WrExportKind *kind,
                            WrExportPreview *picture, WrError *err)
{
    *picture = (WrExportPreview){ 0 };
    WrExportJob job = { .kind = kind,
                        .field = like->field,
                        .scene = like->scene,
                        .options = like->options,
                        .pool = like->pool,
                        .picture = picture };
    return run_scaled(&job, picture_path(&job), err);
}

bool wr_export_levels(const WrExportKind *kind, const WrDocument *document,
                      const WrExportOptions *options, WrPool *pool, WrLevels *levels, WrError *err)
{
    WrExportJob job = { .kind = kind,
                        .field = wr_document_whole(document, NULL, err),
                        .scene = document->scene,
                        .options = *options,
                        .channels = kind->channels,
                        .pool = pool };
    *levels = (WrLevels){ 0 };
    if (!job.field) return false;
    if (!settle_options(kind, kind->channels, job.scene, "levels.exr", &job.options, err))
        return false;
    job.analytic = job.scene->analytic.kind != WR_ANALYTIC_OFF;
    set_grid(&job);
    const bool good =
        wr_levels_make(levels, job.width, job.height, wr_export_bump_slopes_level, &job, pool, err);
    wr_free(job.u);
    return good;
}

static void add_count(WrText *text, int64_t count, const char *what)
{
    if (count > 0)
        wr_text_addf(text, "; %lld texel%s %s", (long long)count, count == 1 ? "" : "s", what);
}

static void add_receipt(const WrExportReport *report, WrText *text)
{
    wr_text_add(text, "; read back: ");
    if (report->worst > 0)
        wr_text_addf(text, "wrong by at most %.3g%s", report->worst,
                     report->convention ? " degrees" : "");
    else wr_text_add(text, "exact");
}

static void add_solid(const WrExportReport *report, WrText *text)
{
    const double *size = report->solid_size;
    wr_text_addf(text, "%lld triangle%s, off by at most %.3g mm; %.6g x %.6g x %.6g mm",
                 (long long)report->triangles, report->triangles == 1 ? "" : "s",
                 report->solid_error, size[0], size[1], size[2]);
    if (report->solid_open)
        wr_text_add(text, report->solid_faults.count[WR_MESH_FAULT_OPEN] > 0
                              ? ", open, as the mesh is"
                              : ", no closed body, as the mesh is none");
    else wr_text_addf(text, ", volume %.6g mm3", report->solid_volume);
    if (report->solid_missed > 0)
        wr_text_addf(text,
                     "; triangles in which the relief is too steep for the requested error: %lld",
                     (long long)report->solid_missed);
    if (report->solid_steps > 0)
        wr_text_addf(
            text, "; triangles that span a step of the relief at hard edges or seams of u, v: %lld",
            (long long)report->solid_steps);
    if (report->solid_limited > 0)
        wr_text_addf(text,
                     "; points of lowered relief, which would fold over or meet other relief: %lld",
                     (long long)report->solid_limited);
    if (report->solid_thin > 0)
        wr_text_addf(
            text,
            "; points at which the relief is deeper than half the wall or gap: %lld, most at "
            "%.6g,%.6g,%.6g: a lower height, or folds=limit",
            (long long)report->solid_thin, report->solid_thinnest[0], report->solid_thinnest[1],
            report->solid_thinnest[2]);
    if (report->solid_folds > 0)
        wr_text_addf(text,
                     "; triangles folded over by the relief: %lld, the highest at "
                     "%.6g,%.6g,%.6g: a lower height, or folds=limit",
                     (long long)report->solid_folds, report->solid_fold[0], report->solid_fold[1],
                     report->solid_fold[2]);
    const double *place = report->solid_left_out, relief = report->solid_relief;
    /* a flat face is off by a third of it or more */
    if (!(relief > 1e-6 * report->solid_allowed))
        wr_text_add(text, "; no relief: the table is flat, or its height 0");
    else if (relief <= 3 * report->solid_error)
        wr_text_addf(text,
                     "; the relief is %.3g mm from its lowest to its highest and error=%.3g: much "
                     "of it is lost; error=%.1g keeps it",
                     relief, report->solid_allowed, relief / 10);
    if (place[0] != 0 || place[1] != 0 || place[2] != 0)
        wr_text_addf(text,
                     "; it stands at 0,0,0 instead of %.9g,%.9g,%.9g mm, where the file's mesh "
                     "does: 32-bit coordinates would lose the relief there",
                     place[0], place[1], place[2]);
    wr_mesh_faults_text(&report->solid_faults, text);
}

/* Of several objects. */
static void add_object(const WrExportReport *report, WrText *text)
{
    if (report->objects == 0) return;
    wr_text_addf(text, "; object %d of %d", report->object, report->objects);
    if (*report->object_name) wr_text_addf(text, ", %s", report->object_name);
}

static void add_facts(const WrExportReport *report, WrText *text)
{
    if (report->model) {
        wr_text_addf(text, "%lld triangle%s, %d map%s", (long long)report->triangles,
                     report->triangles == 1 ? "" : "s", report->pictures,
                     report->pictures == 1 ? "" : "s");
        add_object(report, text);
        return;
    }
    if (report->triangles) {
        add_solid(report, text);
        add_object(report, text);
        return;
    }
    if (report->lines) {
        wr_text_addf(text, "%dx%d pixels", report->width, report->height);
        if (report->lines > 1)
            wr_text_addf(text, ", %lld visible stretches of lines", (long long)report->lines);
        return;
    }
    wr_text_addf(text, "%dx%d, %s", report->width, report->height,
                 report->depth == 8    ? "8 bits"
                 : report->depth == 16 ? "16 bits"
                 : report->half        ? "16-bit floats"
                                       : "32-bit floats");
    if (report->channels == 1) {
        char buffer[WR_NUMBER_SIZE];
        wr_text_addf(text, ", %s %s", report->quantity ? report->quantity : "heights",
                     wr_number_print_float((float)report->low, buffer));
        wr_text_addf(text, " to %s", wr_number_print_float((float)report->high, buffer));
    }
    if (report->ranged) {
        wr_text_add(text, ", codes are ");
        wr_text_add_number(text, report->code_low);
        wr_text_add(text, " to ");
        wr_text_add_number(text, report->code_high);
        if (report->zero_code >= 0) wr_text_addf(text, " with 0 at code %d", report->zero_code);
    }
    if (report->convention) wr_text_addf(text, ", %s", report->convention);
    add_count(text, report->clipped, "outside the range, clipped");
    add_count(text, report->replaced, "not finite, replaced by 0");
    if (report->overlap.share > WR_UV_OVERLAP_NOTED)
        wr_text_addf(text,
                     "; %.1f%% of the texture coordinates are met twice, the first at u, v of "
                     "%.3g,%.3g: the map has one of the places there",
                     100 * report->overlap.share, report->overlap.at[0], report->overlap.at[1]);
    if (report->table_sized)
        wr_text_add(text, "; as large as the table: size=WIDTHxHEIGHT makes another size");
    add_object(report, text);
    if (report->seen) add_receipt(report, text);
    if (report->unseen)
        wr_text_add(text,
                    "; read back whole, but not compared with the table: a limit on file sizes "
                    "(ulimit -f) leaves no room for its rows");
}

void wr_export_report_text(const WrExportReport *report, WrText *text)
{
    add_facts(report, text);
    if (report->triangles && !report->model) return; /* a body has no edges of a cell */
    wr_text_add(text, "; ");
    wr_certificate_text(&report->seam, text);
}
