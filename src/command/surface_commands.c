/* Surface and bump commands: surface, rotate, analytic, bump, replicate. */
#include "base/error.h"
#include "field/scheme_list.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "field/analytic.h"
#include "scene/param.h"
#include "scene/objects.h"
#include "surface/data.h"

#include <math.h>
#include <string.h>

static void print_shape(const WrScene *scene, bool content, WrText *text)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    const double *value = scene->shape.value;
    wr_text_addf(text, "surface %s", info->name);
    for (int k = 0; k < WR_SURFACE_PARAMS && info->params[k].name; k++) {
        int components = info->params[k].components, point = components <= 3 ? components : 3;
        wr_text_addf(text, " %s=", info->params[k].name);
        for (int i = 0; i < components; i++) {
            if (i > 0) wr_text_add(text, i % point == 0 ? ";" : ",");
            wr_text_add_number(text, *value++);
        }
    }
    for (int k = 0; k < WR_SURFACE_TEXTS && info->texts[k].name; k++) {
        wr_text_addf(text, " %s=", info->texts[k].name);
        wr_text_add_word(text, scene->shape.data->text[k]);
    }
    if (info->held) wr_print_mesh(scene, content, text);
    wr_text_add(text, "\n");
}

static void print_surface(const WrScene *scene, WrText *text)
{
    print_shape(scene, false, text);
}

static void print_surface_content(const WrScene *scene, WrText *text)
{
    print_shape(scene, true, text);
}

void wr_print_rotate(const WrScene *scene, WrText *text)
{
    if (!scene->posed) return;
    wr_text_add(text, "rotate ");
    wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_ROTATE], scene, text);
    wr_text_add(text, "\n");
}

static void print_analytic(const WrScene *scene, WrText *text)
{
    const WrAnalytic *analytic = &scene->analytic;
    if (analytic->kind == WR_ANALYTIC_OFF) return;
    bool fourier = analytic->kind == WR_ANALYTIC_FOURIER;
    wr_text_add(text, fourier ? "analytic fourier terms=" : "analytic poly c=");
    for (int i = 0; i < analytic->count; i++) {
        const WrAnalyticTerm *term = &analytic->terms[i];
        wr_text_addf(text, "%s%d,%d,", i ? ";" : "", term->i, term->j);
        wr_text_add_number(text, term->a);
        if (!fourier || (term->phase_u_deg == 0 && term->phase_v_deg == 0)) continue;
        wr_text_add(text, ",");
        wr_text_add_number(text, term->phase_u_deg);
        wr_text_add(text, ",");
        wr_text_add_number(text, term->phase_v_deg);
    }
    wr_text_add(text, "\n");
}

static void print_bump(const WrScene *scene, WrText *text)
{
    wr_text_addf(text, "bump mode=%s scheme=%s", wr_bumps[scene->bump].name,
                 wr_schemes[scene->scheme].name);
    wr_scene_print_params("bump", NULL, scene, text);
    wr_text_add(text, "\n");
}

static void print_replicate(const WrScene *scene, WrText *text)
{
    wr_text_add(text, "replicate ");
    wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_REPLICATE], scene, text);
    wr_text_add(text, "\n");
}

/* HC41: on a closed surface a replication that is not an integer leaves a seam. */
static void warn_seam(WrSession *session, const WrScene *scene)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    double u = scene->replicate_u, v = scene->replicate_v;
    if ((info->closed_u && u != floor(u)) || (info->closed_v && v != floor(v)))
        wr_session_note(
            session,
            "replicate %g,%g leaves a seam on the %s, which is closed: whole numbers do not", u, v,
            info->name);
}

/* Compile a surface's texts; *made stays NULL without texts. */
static bool make_data(const WrCall *call, WrSurfaceKind kind, WrSurfaceData **made, WrError *err)
{
    const WrSurfaceInfo *info = wr_surfaces[kind];
    const char *text[WR_SURFACE_TEXTS] = { NULL };
    if (!info->make) return true;
    for (int k = 0; k < WR_SURFACE_TEXTS && info->texts[k].name; k++)
        if (wr_call_given(call, info->texts[k].name))
            text[k] = wr_call_arg(call, info->texts[k].name)->text;
    *made = wr_surface_data_make(kind, text, err);
    return *made != NULL;
}

static bool run_surface(WrSession *session, WrCall *call, WrError *err)
{
    WrSurfaceData *data = NULL;
    WrShape shape = { .kind = (WrSurfaceKind)call->form };
    wr_shape_default(shape.kind, &shape);
    for (int i = 0; i < call->count; i++) {
        if (!call->args[i].given) continue;
        int offset = wr_surface_param_offset(shape.kind, call->specs[i].name);
        if (offset < 0) continue; /* a text or a mesh file, not a number */
        memcpy(shape.value + offset, call->args[i].numbers,
               (size_t)call->args[i].rows * (size_t)wr_arg_width(&call->specs[i]) * sizeof(double));
    }
    if (!wr_shape_check(&shape, err) || !make_data(call, shape.kind, &data, err)) return false;
    if (data) wr_shape_take_data(&shape, data);
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_set_triangles(scene, NULL, NULL, NULL);
    wr_free(scene->form_layer);
    scene->form_layer = NULL;
    wr_scene_set_shape(scene, &shape);
    wr_surface_data_free(data);
    if (wr_surfaces[shape.kind]->held && !wr_run_mesh(session, call, scene, err)) {
        wr_scene_free(scene);
        return false;
    }
    warn_seam(session, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

/* The edit that turns one of several objects; false where the call has neither or both. */
static bool rotate_as_edit(const WrCall *call, WrText *text)
{
    const bool own = wr_call_given(call, "pose");
    const WrArg *turn = wr_call_arg(call, "x,y,z");
    if (own == turn->given) return false;
    wr_text_add(text, "object set turn=");
    if (own) wr_text_add(text, WR_OWN_TURN);
    for (int i = 0; turn->given && i < 3; i++) {
        if (i > 0) wr_text_add(text, ",");
        wr_text_add_number(text, turn->numbers[i]);
    }
    return true;
}

static bool run_rotate(WrSession *session, WrCall *call, WrError *err)
{
    bool own = wr_call_given(call, "pose"), turned = wr_call_given(call, "x,y,z");
    if (own == turned) return wr_fail(err, "needs one of x,y,z and pose=own");
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->posed = turned;
    scene->rotate_deg = (WrVec3){ 0 };
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

enum { FORM_POLY, FORM_FOURIER, FORM_OFF, ANALYTIC_FORMS };

static bool run_analytic(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WR_ROWS(forms);
    static const struct {
        const char *list;
        WrAnalyticKind kind;
    } forms[] = { [WR_ROW(FORM_POLY)] = { "c", WR_ANALYTIC_POLY },
                  [WR_ROW(FORM_FOURIER)] = { "terms", WR_ANALYTIC_FOURIER },
                  [WR_ROW(FORM_OFF)] = { NULL, WR_ANALYTIC_OFF } };
    WR_ROWS_END(forms, ANALYTIC_FORMS);
    const int which = call->form;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_free(scene->analytic.terms);
    scene->analytic = (WrAnalytic){ .kind = forms[which].kind };
    if (forms[which].list) {
        const WrArg *list = wr_call_arg(call, forms[which].list);
        size_t width = forms[which].kind == WR_ANALYTIC_POLY ? 3 : 5;
        scene->analytic.terms = wr_alloc((size_t)list->rows, sizeof *scene->analytic.terms);
        scene->analytic.count = list->rows;
        for (int i = 0; i < list->rows; i++) {
            const double *row = list->numbers + width * (size_t)i;
            scene->analytic.terms[i] =
                (WrAnalyticTerm){ (int)row[0], (int)row[1], row[2], width > 3 ? row[3] : 0,
                                  width > 3 ? row[4] : 0 };
        }
    }
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_bump(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (wr_call_given(call, "mode")) scene->bump = (WrBumpMode)wr_call_choice(call, "mode");
    if (wr_call_given(call, "scheme")) scene->scheme = (WrScheme)wr_call_choice(call, "scheme");
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_replicate(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_take(call, NULL, scene);
    warn_seam(session, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static const char *bump_name(int i)
{
    return i < WR_BUMP_COUNT ? wr_bumps[i].name : NULL;
}

static const char *scheme_name(int i)
{
    return i < WR_SCHEME_COUNT ? wr_schemes[i].name : NULL;
}

static const WrComponent poly_parts[] = { { "i", 0, 64, true },
                                          { "j", 0, 64, true },
                                          { "a", -1e30, 1e30, false } };

static const WrComponent fourier_parts[] = {
    { "k", -16384, 16384, true },    { "l", -16384, 16384, true },    { "a", -1e30, 1e30, false },
    { "phase_u", -1e9, 1e9, false }, { "phase_v", -1e9, 1e9, false },
};

WR_ROWS(analytic_forms);
static const WrForm analytic_forms[] = {
    [WR_ROW(FORM_POLY)] = { .name = "poly",
                            .help = "sum of a u^i v^j",
                            .args = { { .name = "c",
                                        .type = WR_ARG_LIST,
                                        .required = true,
                                        .components = 3,
                                        .parts = poly_parts,
                                        .rows_low = 1,
                                        .rows_high = WR_TERMS_MAX,
                                        .shape = "i,j,a;...",
                                        .help = "the terms" } } },
    [WR_ROW(FORM_FOURIER)] = { .name = "fourier",
                               .help = "sum of a cos(2 pi k u + phase_u) cos(2 pi l v + phase_v), "
                                       "phases in degrees",
                               .args = { { .name = "terms",
                                           .type = WR_ARG_LIST,
                                           .required = true,
                                           .components = 5,
                                           .parts = fourier_parts,
                                           .counts = TUPLE_OF(3) | TUPLE_OF(5),
                                           .rows_low = 1,
                                           .rows_high = WR_TERMS_MAX,
                                           .shape = "k,l,a[,phase_u,phase_v];...",
                                           .help = "the terms" } } },
    [WR_ROW(FORM_OFF)] = { .name = "off", .help = "the table again" },
};
WR_ROWS_END(analytic_forms, ANALYTIC_FORMS);

WR_FORMS(form_analytic, analytic_forms)

/* A surface's parameters as arguments; numbers with 3n components are lists of n points. */
static bool form_surface(int i, WrForm *out)
{
    if (i >= WR_SURFACE_COUNT) return false;
    const WrSurfaceInfo *info = wr_surfaces[i];
    *out = (WrForm){ .name = info->name, .help = info->help };
    int count = 0;
    for (int k = 0; k < WR_SURFACE_PARAMS && info->params[k].name; k++) {
        const WrSurfaceParam *p = &info->params[k];
        WrArgSpec spec = { .name = p->name,
                           .low = p->low,
                           .high = p->high,
                           .help = p->help,
                           .fallback = p->fallback };
        spec.type = p->components == 1   ? WR_ARG_NUMBER
                    : p->components <= 3 ? WR_ARG_TUPLE
                                         : WR_ARG_LIST;
        spec.components = p->components <= 3 ? p->components : 3;
        if (spec.type == WR_ARG_LIST) {
            spec.rows_low = spec.rows_high = spec.fallback_rows = p->components / 3;
            spec.shape = "x,y,z;...";
        }
        out->args[count++] = spec;
    }
    for (int k = 0; k < WR_SURFACE_TEXTS && info->texts[k].name; k++)
        out->args[count++] = (WrArgSpec){ .name = info->texts[k].name,
                                          .type = WR_ARG_TEXT,
                                          .shape = info->texts[k].shape,
                                          .fallback_text = info->texts[k].fallback,
                                          .help = info->texts[k].help };
    if (info->held) wr_form_mesh((WrSurfaceKind)i, out->args + count);
    return true;
}

static bool row_bump(WrForm *out)
{
    *out = (WrForm){ .args = { { .name = "mode",
                                 .type = WR_ARG_CHOICE,
                                 .choice = bump_name,
                                 .help = "how the normal is made: unchanged, the paper's N + D, "
                                         "the same whatever the scale, or "
                                         "the true normal of the displaced surface" },
                               { .name = "scheme",
                                 .type = WR_ARG_CHOICE,
                                 .choice = scheme_name,
                                 .help = "how F is differentiated" } } };
    return wr_scene_args("bump", NULL, out->args + 2) > 0;
}

static bool row_replicate(WrForm *out)
{
    *out = (WrForm){ 0 };
    return wr_scene_args("replicate", NULL, out->args) > 0;
}

static const char *pose_word(int i)
{
    return i == 0 ? "own" : NULL;
}

static bool row_rotate(WrForm *out)
{
    *out = (WrForm){ 0 };
    const int count = wr_scene_args("rotate", NULL, out->args);
    out->args[count] =
        (WrArgSpec){ .name = "pose",
                     .type = WR_ARG_CHOICE,
                     .choice = pose_word,
                     .help = "instead: the pose in which each surface first shows itself" };
    return true;
}

/* ---- the rows ---- */

const WrCommand wr_command_surface = {
    .name = "surface",
    .kind = WR_CLASS_SCENE,
    .form_word = "NAME",
    .form = form_surface,
    .run = run_surface,
    .print = print_surface,
    .print_content = print_surface_content,
    .of_object = true,
    .help = "the surface that the table wrinkles",
    .details =
        "Parameters that are left out take their defaults. A mesh without a file is a square of "
        "two triangles. On a cube faces=6 gives each face a cell of its own of the table, three "
        "beside two from the lower left (front, right, back; left, top, bottom), within a margin "
        "of a 32nd: in cells of 64 texels and more no scheme but bspline-fit, and no filter, "
        "reads another face's heights.",
    .example = "surface torus R=1 r=0.35"
};

const WrCommand wr_command_rotate = {
    .name = "rotate",
    .kind = WR_CLASS_VIEW,
    .row = row_rotate,
    .run = run_rotate,
    .print = wr_print_rotate,
    .in_object = true,
    .of_several = rotate_as_edit,
    .of_object = true,
    .help = "the object's orientation",
    .details =
        "It replaces the pose in which the surface first shows itself, and turns about the "
        "object's centre. A view is no edit: undo leaves it as it is, `view back` goes back. Of "
        "several objects, a ground being one, it turns the chosen one, which is an edit: "
        "`object set turn=`.",
    .example = "rotate -90,0,30"
};

const WrCommand wr_command_analytic = {
    .name = "analytic",
    .kind = WR_CLASS_SCENE,
    .form_word = "KIND",
    .form = form_analytic,
    .run = run_analytic,
    .print = print_analytic,
    .of_object = true,
    .help = "a formula in place of the table",
    .details = "It is evaluated at (ru u, rv v) reduced to [0,1), like a table, with exact "
               "derivatives.",
    .example = "analytic fourier terms=3,0,0.5;0,5,0.25,90,0"
};

const WrCommand wr_command_bump = { .name = "bump",
                                    .kind = WR_CLASS_SCENE,
                                    .row = row_bump,
                                    .run = run_bump,
                                    .print = print_bump,
                                    .of_object = true,
                                    .help = "how the table turns the normal",
                                    .details = "Only what is given changes.",
                                    .example = "bump mode=exact height=0.05" };

const WrCommand wr_command_replicate = { .name = "replicate",
                                         .kind = WR_CLASS_SCENE,
                                         .row = row_replicate,
                                         .run = run_replicate,
                                         .print = print_replicate,
                                         .of_object = true,
                                         .help = "how often the table repeats over the surface",
                                         .example = "replicate 6,3" };
