/* The scene as the canonical lines that restore it from a new document. Every setting is written out,
   defaults too, so that a document means the same whatever the defaults of a later version are. Only
   the light of a new document, the surface's own pose and a missing picture have no line. */
#include "command/inner.h"

/* "x,y,z" */
static void add_vec3(WrText *text, WrVec3 a)
{
    wr_text_add_number(text, a.x);
    wr_text_add(text, ",");
    wr_text_add_number(text, a.y);
    wr_text_add(text, ",");
    wr_text_add_number(text, a.z);
}

/* " name=x" */
static void add_named(WrText *text, const char *name, double x)
{
    wr_text_addf(text, " %s=", name);
    wr_text_add_number(text, x);
}

static void add_named_vec3(WrText *text, const char *name, WrVec3 a)
{
    wr_text_addf(text, " %s=", name);
    add_vec3(text, a);
}

void wr_print_surface(const WrScene *scene, WrText *text)
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
    wr_text_add(text, "\n");
}

void wr_print_rotate(const WrScene *scene, WrText *text)
{
    if (!scene->posed) return;
    wr_text_add(text, "rotate ");
    add_vec3(text, scene->rotate_deg);
    wr_text_add(text, "\n");
}

void wr_print_analytic(const WrScene *scene, WrText *text)
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

void wr_print_bump(const WrScene *scene, WrText *text)
{
    wr_text_addf(text, "bump mode=%s scheme=%s", wr_bump_names[scene->bump],
                 wr_schemes[scene->scheme].name);
    add_named(text, "height", scene->height);
    wr_text_add(text, "\n");
}

void wr_print_replicate(const WrScene *scene, WrText *text)
{
    wr_text_add(text, "replicate ");
    wr_text_add_number(text, scene->replicate_u);
    wr_text_add(text, ",");
    wr_text_add_number(text, scene->replicate_v);
    wr_text_add(text, "\n");
}

void wr_print_material(const WrScene *scene, WrText *text)
{
    const WrMaterial *m = &scene->material;
    wr_text_add(text, "material");
    add_named(text, "ambient", m->ambient);
    add_named(text, "diffuse", m->diffuse);
    add_named(text, "specular", m->specular);
    add_named(text, "shininess", m->shininess);
    add_named_vec3(text, "colour", m->colour);
    wr_text_addf(text, " gate=%s\n", m->gate ? "on" : "off");
}

void wr_print_colour(const WrScene *scene, WrText *text)
{
    if (!scene->colour) return;
    wr_text_add(text, "colour ");
    wr_text_add_word(text, scene->colour_path);
    if (*scene->colour_sha256) wr_text_addf(text, " sha256=%s", scene->colour_sha256);
    wr_text_add(text, "\n");
}

void wr_print_light(const WrScene *scene, WrText *text)
{
    if (scene->lights_given && scene->light_count == 0) wr_text_add(text, "light clear\n");
    for (int i = 0; scene->lights_given && i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        bool point = light->kind == WR_LIGHT_POINT;
        wr_text_addf(text, "light %s", point ? "point" : "directional");
        add_named_vec3(text, point ? "at" : "to", light->where);
        add_named_vec3(text, "colour", light->colour);
        add_named(text, "strength", light->strength);
        wr_text_add(text, "\n");
    }
}

/* The number of the other kind of camera is kept too, by a line of its own before. */
void wr_print_camera(const WrScene *scene, WrText *text)
{
    const WrCamera *camera = &scene->camera;
    wr_text_addf(text, "camera %s", wr_camera_kind_name(camera->orthographic ? 0 : 1));
    add_named(text, camera->orthographic ? "fov" : "size",
              camera->orthographic ? camera->fov_deg : camera->size);
    wr_text_addf(text, "\ncamera %s", wr_camera_kind_name(camera->orthographic ? 1 : 0));
    add_named_vec3(text, "eye", camera->eye);
    add_named_vec3(text, "target", camera->target);
    add_named_vec3(text, "up", camera->up);
    wr_text_addf(text, " fit=%s", camera->fit ? "on" : "off");
    add_named(text, camera->orthographic ? "size" : "fov",
              camera->orthographic ? camera->size : camera->fov_deg);
    wr_text_add(text, "\n");
}

void wr_print_dials(const WrScene *scene, WrText *text)
{
    WrText dials = { 0 };
    wr_dials_print(scene, "dials", true, &dials);
    wr_text_addf(text, "dials %s\n", wr_text_get(&dials));
    wr_text_fini(&dials);
}

void wr_print_tolerance(const WrScene *scene, WrText *text)
{
    static const char *const names[WR_TOLERANCE_COUNT] = { " off", " rms=", " max=", " time=" };
    const WrTolerance *tolerance = &scene->tolerance;
    wr_text_addf(text, "tolerance%s", names[tolerance->kind]);
    if (tolerance->kind != WR_TOLERANCE_NONE) wr_text_add_number(text, tolerance->value);
    wr_text_add(text, tolerance->kind == WR_TOLERANCE_TIME ? "s\n" : "\n");
}

static void print_colour_content(const WrScene *scene, WrText *text)
{
    if (scene->colour && *scene->colour_sha256)
        wr_text_addf(text, "colour sha256=%s\n", scene->colour_sha256);
    else wr_print_colour(scene, text);
}

void wr_print_identity(const WrScene *scene, WrText *text)
{
    for (int i = 0; i < wr_command_count; i++) {
        if (wr_commands[i].print == wr_print_colour) print_colour_content(scene, text);
        else if (wr_commands[i].print) wr_commands[i].print(scene, text);
    }
}
