#include "cli/cli.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/commands.h"
#include "command/session.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "document/document_file.h"
#include "field/field.h"
#include "generate/noise_generators.h"
#include "scene/texture_sample.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "surface/patches.h"
#include "surface/surface.h"
#include "surface/terrain.h"
#include "surface/triangles.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* All quantities of the formulas at one point, in double precision, object space. */
typedef struct Quantities {
    double u, v, f, fu, fv, tilt_deg;
    WrSurfacePoint point;
    WrVec3 a, d, n_perturbed, n_perturbed_unit;
    bool turned;    /* mode invariant: uses D' instead of D */
    WrVec3 d_prime; /* N_perturbed - N in that mode */
} Quantities;

/* D' = a D |N| / |D|, a = sqrt(Fu^2 + Fv^2); 0 where D or N is. */
static WrVec3 scaled_d(const Quantities *q)
{
    const WrVec3 zero = { 0, 0, 0 };
    const double slope = hypot(q->fu, q->fv), size = slope * v3_len(q->point.n);
    return v3_scale(v3_unit(q->d, zero), size <= DBL_MAX ? size : DBL_MAX);
}

/* The surface point is in q->u, q->v and q->point. field: the object's table. */
static void compute(const WrScene *scene, const WrField *field, Quantities *q)
{
    const double u = q->u, v = q->v;
    WrSurfacePoint *p = &q->point;
    wr_scene_slopes(scene, field, p, u, v, &q->f, &q->fu, &q->fv);
    q->a = wr_bump_axis(p->pu, p->pv, q->fu, q->fv);
    q->d = wr_bump_d(p->n_unit, p->pu, p->pv, q->fu, q->fv);
    q->turned = scene->bump == WR_BUMP_INVARIANT;
    q->d_prime = scaled_d(q);
    /* the same condition as in pictures */
    const bool blinn = scene->triangles && scene->bump == WR_BUMP_EXACT;
    q->n_perturbed = wr_bump_normal(blinn ? WR_BUMP_BLINN : scene->bump, p->n, p->n_unit, p->pu,
                                    p->pv, p->n_u, p->n_v, q->f, q->fu, q->fv);
    /* An unchanged N keeps n: normalising N again could differ in the last digit. */
    const bool still = memcmp(&q->n_perturbed, &p->n, sizeof p->n) == 0;
    q->n_perturbed_unit = still ? p->n_unit : wr_bump_unit(q->n_perturbed, p->n_unit);
    q->tilt_deg = wr_bump_tilt_deg(p->n_unit, q->n_perturbed_unit);
}

/* ---- output ---- */

static void add_name(WrText *text, bool json, const char *name)
{
    if (json) wr_text_addf(text, "%s\"%s\":", text->data[text->length - 1] == '{' ? "" : ",", name);
    else wr_text_addf(text, "%-12s ", name);
}

static void add_number(WrText *text, bool json, const char *name, double x)
{
    add_name(text, json, name);
    if (json) wr_text_add_json_number(text, x);
    else wr_text_add_number(text, x);
    if (!json) wr_text_add(text, "\n");
}

static void add_vector(WrText *text, bool json, const char *name, WrVec3 a)
{
    const double c[3] = { a.x, a.y, a.z };
    add_name(text, json, name);
    if (json) wr_text_add(text, "[");
    for (int i = 0; i < 3; i++) {
        char number[WR_NUMBER_SIZE];
        if (json) {
            wr_text_add(text, i ? "," : "");
            wr_text_add_json_number(text, c[i]);
        } else {
            wr_text_addf(text, i < 2 ? "%-24s " : "%s", wr_number_print(c[i], number));
        }
    }
    wr_text_add(text, json ? "]" : "\n");
}

/* Print the name of the object if there are several. */
static void add_object(WrText *text, bool json, const WrScene *scene)
{
    char buffer[WR_OBJECT_LABEL];
    const char *label = wr_scene_object_label(scene, scene->chosen, buffer);
    if (wr_scene_object_count(scene) == 1) return;
    add_name(text, json, "object");
    if (json) wr_text_add_json_string(text, label);
    else wr_text_addf(text, "%s\n", label);
}

static void add_point(WrText *text, bool json, const WrScene *scene, const Quantities *q)
{
    const WrSurfacePoint *p = &q->point;
    if (json) wr_text_add(text, "{");
    else if (text->length) wr_text_add(text, "\n");
    add_object(text, json, scene);
    add_number(text, json, "u", q->u);
    add_number(text, json, "v", q->v);
    add_vector(text, json, "P", p->p);
    add_vector(text, json, "Pu", p->pu);
    add_vector(text, json, "Pv", p->pv);
    add_vector(text, json, "Puu", p->puu);
    add_vector(text, json, "Puv", p->puv);
    add_vector(text, json, "Pvv", p->pvv);
    add_vector(text, json, "N", p->n);
    add_vector(text, json, "n", p->n_unit);
    add_number(text, json, "F", q->f);
    add_number(text, json, "Fu", q->fu);
    add_number(text, json, "Fv", q->fv);
    add_vector(text, json, "A", q->a);
    add_vector(text, json, "D", q->d);
    if (q->turned) add_vector(text, json, "D_prime", q->d_prime);
    add_vector(text, json, "N_perturbed", q->n_perturbed);
    add_vector(text, json, "n_perturbed", q->n_perturbed_unit);
    add_number(text, json, "tilt_deg", q->tilt_deg);
    if (json) wr_text_add(text, "}\n");
}

/* Print the noise of a command line: N and its slopes, and the resulting heights F = level + amplitude N. */
static void add_noise(WrText *text, bool json, const WrNoiseMaker *maker, double u, double v)
{
    WrNoiseReading r;
    wr_noise_maker_sample(maker, u, v, &r);
    if (json) wr_text_add(text, "{");
    else if (text->length) wr_text_add(text, "\n");
    add_number(text, json, "u", u);
    add_number(text, json, "v", v);
    add_number(text, json, "noise", r.n);
    add_number(text, json, "noise_u", r.nu);
    add_number(text, json, "noise_v", r.nv);
    add_number(text, json, "F", r.f);
    add_number(text, json, "Fu", r.fu);
    add_number(text, json, "Fv", r.fv);
    add_number(text, json, "octaves", maker->plan.used);
    if (json) wr_text_add(text, "}\n");
}

/* Print {"name":"moss","blend":"max","opacity":0.5,...}, bottom first. */
static void add_layer_json(WrText *text, const WrDocument *document, int index)
{
    const WrLayer *layer = &document->layers[index];
    wr_text_add(text, index ? ",{\"name\":" : "{\"name\":");
    wr_text_add_json_string(text, layer->name);
    wr_text_addf(text, ",\"blend\":\"%s\",\"opacity\":", wr_blends[layer->blend].name);
    wr_text_add_json_number(text, (double)layer->opacity);
    wr_text_add(text, ",\"radius\":");
    wr_text_add_json_number(text, (double)layer->radius);
    wr_text_addf(text,
                 ",\"visible\":%s,\"locked\":%s,\"cover\":%s,\"mask\":%s,\"active\":%s,"
                 "\"solo\":%s",
                 layer->visible ? "true" : "false", layer->locked ? "true" : "false",
                 layer->cover ? "true" : "false", layer->mask ? "true" : "false",
                 document->active == index ? "true" : "false",
                 document->solo == index ? "true" : "false");
    WrText filter = { 0 };
    if (layer->filter.op) wr_filter_print(&layer->filter, &filter);
    if (layer->filter.op) wr_text_add(text, ",\"filter\":");
    if (layer->filter.op) wr_text_add_json_string(text, filter.data);
    if (layer->is_group || layer->depth)
        wr_text_addf(text, ",\"depth\":%d,\"group\":%s", layer->depth,
                     layer->is_group ? "true" : "false");
    if (layer->line) wr_text_add(text, ",\"line\":");
    if (layer->line) wr_text_add_json_string(text, layer->line);
    if (layer->mask_line) wr_text_add(text, ",\"mask_line\":");
    if (layer->mask_line) wr_text_add_json_string(text, layer->mask_line);
    wr_text_add(text, "}");
    wr_text_fini(&filter);
}

/* Print "  2 moss  max, opacity 0.5, hidden", top first, in stacking order; members of groups are indented. */
static void add_layer_text(WrText *text, const WrDocument *document, int index)
{
    const WrLayer *layer = &document->layers[index];
    char number[WR_NUMBER_SIZE];
    wr_text_addf(text, "%c %-10d %*s%s  %s%s, opacity %s", document->active == index ? '>' : ' ',
                 index + 1, 2 * layer->depth, "", layer->name, layer->is_group ? "group, " : "",
                 wr_blends[layer->blend].name, wr_number_print_float(layer->opacity, number));
    if (wr_blends[layer->blend].uses_radius)
        wr_text_addf(text, ", radius %s", wr_number_print_float(layer->radius, number));
    if (layer->filter.op) {
        wr_text_add(text, ", filter ");
        wr_filter_print(&layer->filter, text);
    }
    if (layer->line) wr_text_addf(text, ", from \"%s\"", layer->line);
    if (layer->mask) wr_text_add(text, ", masked");
    if (layer->mask_line) wr_text_addf(text, " by \"%s\"", layer->mask_line);
    if (!layer->visible) wr_text_add(text, ", hidden");
    if (layer->locked) wr_text_add(text, ", locked");
    if (document->solo == index) wr_text_add(text, ", alone");
    wr_text_add(text, "\n");
}

static void add_summary_json(WrText *text, const WrDocument *document, const char *hash)
{
    const WrField *field = wr_document_field(document);
    wr_text_addf(text, "{\"size\":[%d,%d],\"layers\":%d,\"hash\":\"%s\",\"layer_list\":[",
                 wr_field_width(field), wr_field_height(field), document->layer_count, hash);
    for (int i = 0; i < document->layer_count; i++) add_layer_json(text, document, i);
    wr_text_addf(text, "],\"selection\":%s}\n", document->selection ? "true" : "false");
}

static void add_summary(WrText *text, bool json, const WrSession *session)
{
    const WrDocument *document = wr_session_document(session);
    const WrField *field = wr_document_field(document);
    int width = wr_field_width(field), height = wr_field_height(field);
    char hash[33];
    float low, high;
    wr_hash_print(wr_session_hash(session), hash);
    if (json) {
        add_summary_json(text, document, hash);
        return;
    }
    wr_field_range(field, &low, &high);
    wr_text_addf(text, "size         %dx%d texels\nwrap         %s\nheights      ", width, height,
                 wr_document_wrap_word(wr_field_wrap_u(field), wr_field_wrap_v(field)));
    char number[WR_NUMBER_SIZE];
    wr_text_add(text, wr_number_print_float(low, number));
    wr_text_add(text, " .. ");
    wr_text_add(text, wr_number_print_float(high, number));
    wr_text_addf(text, "\nlayers       %d\n", document->layer_count);
    for (int i = document->layer_count - 1; i >= 0; i--) add_layer_text(text, document, i);
    if (document->selection) wr_text_add(text, "selection    part of the table\n");
    wr_text_addf(text, "hash         %s\n\n", hash);
    wr_session_scene_text(session, text);
}

/* ---- points ---- */

static bool parse_point(const char *text, double *u, double *v, WrError *err)
{
    const char *comma = strchr(text, ',');
    if (comma && wr_number_parse(text, (size_t)(comma - text), u) &&
        wr_number_parse(comma + 1, strlen(comma + 1), v))
        return true;
    return wr_fail(err, "%.60s: must be U,V, two numbers", text);
}

#define PLACES 64 /* limit of printed surface points for one (u,v) */

static void note_beyond(const WrShape *shape, double u, double v)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const bool out_u = !info->closed_u && !(u >= 0 && u <= 1);
    const bool out_v = !info->closed_v && !(v >= 0 && v <= 1);
    char text[160];
    if ((!out_u && !out_v) || wr_shape_endless(shape)) return;
    snprintf(text, sizeof text, "--at %g,%g: the %s ends at 0 and 1; its formula was continued", u,
             v, info->name);
    wr_cli_note(text);
}

/* Find the surface points at (u,v): any number for a mesh or a patch set, else one. Returns their number; the first
 * PLACES are in `out`. */
static int64_t find_places(const WrCli *cli, const WrScene *scene, double u, double v,
                           WrSurfacePoint out[PLACES])
{
    const WrTriangles *held = scene->triangles;
    if (held && scene->shape.kind != WR_SURFACE_terrain) {
        WrTrianglesPlace places[PLACES];
        const int64_t count = wr_triangles_find(held, u, v, PLACES, places);
        for (int i = 0; i < PLACES && i < count; i++) wr_triangles_at(held, &places[i], &out[i]);
        return count;
    }
    note_beyond(&scene->shape, u, v);
    if (held) wr_terrain_at(held->patches, u, v, &out[0]);
    else
        wr_surface_at(&scene->shape, wr_surface_face(&scene->shape, cli->face, u, v), u, v,
                      &out[0]);
    return 1;
}

static bool inspect_places(const WrCli *cli, const WrDocument *document, double u, double v,
                           WrText *text, WrError *err)
{
    const WrScene *scene = document->scene;
    WrSurfacePoint at[PLACES];
    char note[120];
    const int64_t count = find_places(cli, scene, u, v, at);
    if (count == 0)
        return wr_fail(err, "%g,%g: the %s has no place with these texture coordinates", u, v,
                       wr_surfaces[scene->shape.kind]->name);
    if (count > 1) {
        snprintf(note, sizeof note, "--at %g,%g: %lld places have these texture coordinates", u, v,
                 (long long)count);
        wr_cli_note(note);
    }
    WrTables *tables = wr_document_tables(document, document->scene, NULL, cli->pool);
    const WrField *field = wr_tables_at_hand(tables, document->scene, wr_document_field(document));
    for (int i = 0; i < PLACES && i < count; i++) {
        Quantities q = { .u = u, .v = v, .point = at[i] };
        compute(scene, field, &q);
        add_point(text, cli->json, scene, &q);
    }
    wr_tables_free(tables);
    return true;
}

/* noise: from --noise, or NULL */
static bool inspect_one(const WrCli *cli, const WrDocument *document, const WrNoiseMaker *noise,
                        const char *at, WrText *text, WrError *err)
{
    double u, v;
    if (!parse_point(at, &u, &v, err)) return false;
    if (!noise) return inspect_places(cli, document, u, v, text, err);
    add_noise(text, cli->json, noise, u, v);
    return true;
}

/* Read points from standard input, one per line; blank lines are skipped. */
static bool inspect_input(const WrCli *cli, const WrDocument *document, const WrNoiseMaker *noise,
                          WrText *text, WrError *err)
{
    char line[256];
    for (int number = 1; fgets(line, sizeof line, stdin); number++) {
        if (wr_cancel_requested(cli->cancel)) return wr_fail(err, "cancelled");
        line[strcspn(line, "\r\n")] = '\0';
        if (*line && !inspect_one(cli, document, noise, line, text, err)) {
            wr_error_prefix(err, "--at -: line %d: ", number);
            return false;
        }
    }
    if (ferror(stdin)) return wr_fail(err, "standard input: %s", strerror(errno));
    return true;
}

/* Parse the command line of --noise for the document's table. */
static bool read_noise(const WrCli *cli, const WrDocument *document, WrNoiseMaker *maker,
                       WrError *err)
{
    WrCall *call;
    if (cli->at_count == 0) return wr_fail(err, "--at U,V is missing: which points?");
    if (!wr_call_parse(cli->noise, false, &call, err)) return false;
    const WrGenerator *row = wr_call_generator(call);
    bool good = row && strcmp(row->family, "noise") == 0;
    if (good) {
        WrParamValue values[WR_GENERATOR_PARAMS];
        const WrField *field = wr_document_field(document);
        wr_call_values(call, row, values);
        good =
            wr_noise_maker(row, values, wr_field_width(field), wr_field_height(field), maker, err);
    } else {
        wr_fail(err, "%.60s: must be a noise command, such as \"noise perlin cells=4\"",
                cli->noise);
    }
    wr_call_free(call);
    return good;
}

static bool inspect(const WrCli *cli, const WrSession *session, WrText *text, WrError *err)
{
    const WrDocument *document = wr_session_document(session);
    const WrSurfaceInfo *surface = wr_surfaces[document->scene->shape.kind];
    if (cli->face >= surface->faces)
        return wr_fail(err, "--face %d: the %s has %s", cli->face, surface->name,
                       surface->faces == 1 ? "only face 0" : "faces 0..5");
    WrNoiseMaker maker;
    const WrNoiseMaker *noise = cli->noise ? &maker : NULL;
    if (noise && !read_noise(cli, document, &maker, err)) {
        wr_error_prefix(err, "--noise: ");
        return false;
    }
    if (cli->at_count == 0) add_summary(text, cli->json, session);
    for (int i = 0; i < cli->at_count; i++) {
        if (strcmp(cli->ats[i], "-") == 0) {
            if (!inspect_input(cli, document, noise, text, err)) return false;
        } else if (!inspect_one(cli, document, noise, cli->ats[i], text, err)) {
            wr_error_prefix(err, "--at ");
            return false;
        }
    }
    return true;
}

int wr_cli_inspect(const WrCli *cli)
{
    WrError err;
    WrText text = { 0 };
    WrSession *session = wr_cli_load(cli, false, &err);
    wr_filters_forget();
    bool good = session && inspect(cli, session, &text, &err) && wr_filters_carried(&err);
    int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&text);
    wr_session_free(session);
    return status;
}
