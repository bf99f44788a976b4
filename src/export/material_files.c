/* Material files of other programs.
   Source: MaterialX specification 1.38 (document, standard nodes, PBR); UsdPreviewSurface specification 2.6; glTF 2.0
   specification 3.8 (textures), 3.9 (materials); KHR_texture_transform, KHR_materials_ior. */
#include "export/material_files.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "export/channel_packing.h"
#include "export/gltf_model.h"
#include "export/job.h"
#include "export/map_sets.h"
#include "image/gltf.h"
#include "image/sidecar.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/reflection.h"
#include "surface/surface.h"
#include "system/clock.h"

#include <expat.h>
#include <math.h>
#include <string.h>

/* ---- textures and numbers of the material ---- */

static const char *const role_names[WR_ROLES] = { "none",      "normal",    "height", "roughness",
                                                  "metalness", "occlusion", "colour" };

/* A picture, or a channel of one: the value is scale * texel + bias. */
typedef struct Texture {
    const char *file; /* borrowed; NULL: none */
    int channels, channel;
    double scale, bias;
    double repeat[2]; /* times over u and v 0..1 of the object */
    bool green_down;
    int map; /* index in the request; -1: the colour picture */
} Texture;

typedef struct Material {
    const WrMaterialRequest *order;
    const WrScene *scene;
    Texture textures[WR_ROLES];
    const char *why[WR_MAP_SET_ENTRIES_MAX]; /* of maps without a role; else NULL */
    double colour[3], roughness, metalness, ior, specular;
    double repeat[2];
    char *picture; /* name of the colour picture; owned; NULL: none */
    WrText id;     /* the name as an identifier */
    unsigned uses; /* bits of roles that the format in hand uses */
} Material;

static bool uses(const Material *m, WrMaterialRole role)
{
    return m->uses >> role & 1;
}

static void give(Material *m, WrMaterialRole role, Texture texture, int map)
{
    texture.map = map;
    texture.file = m->order->maps[map].file;
    if (!m->textures[role].file) m->textures[role] = texture, m->why[map] = NULL;
    else m->why[map] = "another map has its place";
}

/* A map of one channel: 0..1 is code_low..code_high of the report, floats are as they are. */
static Texture plain_texture(const Material *m, const WrMaterialMap *map, double unit)
{
    const WrExportReport *r = &map->report;
    const bool coded = r->ranged;
    Texture t = { .channels = r->channels, .scale = unit };
    if (coded) t.scale = unit * (r->code_high - r->code_low), t.bias = unit * r->code_low;
    const int copies[2] = { map->options.repeat_u, map->options.repeat_v };
    for (int k = 0; k < 2; k++) t.repeat[k] = m->repeat[k] / (copies[k] > 1 ? copies[k] : 1);
    return t;
}

static void give_packed(Material *m, int index)
{
    const WrMaterialMap *map = &m->order->maps[index];
    bool given = false;
    for (int c = 0; c < map->report.channels; c++) {
        bool turned;
        const WrMaterialRole role = wr_export_packed_role(&map->options, c, &turned);
        if (role == WR_ROLE_NONE || m->textures[role].file) continue;
        Texture t = plain_texture(m, map, 1);
        t.channel = c;
        t.scale = turned ? -1 : 1, t.bias = turned;
        give(m, role, t, index);
        given = true;
    }
    m->why[index] = given ? NULL : "no channel that a material needs";
}

static void give_normal(Material *m, int index)
{
    const WrMaterialMap *map = &m->order->maps[index];
    const char *convention = map->report.convention;
    Texture t = plain_texture(m, map, 1);
    t.green_down = convention[0] == '-';
    if (map->kind->on_surface) t.repeat[0] = t.repeat[1] = 1; /* covers the surface */
    if (convention[1] == 'Y') give(m, WR_ROLE_NORMAL, t, index);
    else m->why[index] = "its axes are not those of a tangent space";
}

static void give_map(Material *m, int index)
{
    const WrMaterialMap *map = &m->order->maps[index];
    const WrMaterialRole role = map->kind->role;
    m->why[index] = "no input for it";
    if (map->kind->write) return;
    if (wr_is_raw_path(map->file)) m->why[index] = "a file of numbers";
    else if (map->kind->green != 0 && map->report.convention) give_normal(m, index);
    else if (role == WR_ROLE_CHANNELS) give_packed(m, index);
    else if (role != WR_ROLE_NONE)
        give(m, role, plain_texture(m, map, map->kind->table_units ? wr_scene_relief(m->scene) : 1),
             index);
}

static double within(double x, double most)
{
    return fmin(fmax(x, 0), most);
}

static void take_numbers(Material *m)
{
    const WrMaterial *from = &m->scene->material;
    const WrReflectInfo *model = &wr_reflects[from->model];
    const double colour[3] = { from->colour.x, from->colour.y, from->colour.z };
    for (int c = 0; c < 3; c++) m->colour[c] = within(colour[c], 1);
    m->roughness = within(sqrt(wr_export_material_alpha(m->scene)), 1);
    m->metalness = model->metalness ? within(from->metalness, 1) : 0;
    m->ior = model->ior && from->ior >= 1 ? from->ior : 1.5;
    /* The highlight of a lobe with shininess has no scale in common with that of facets: it is on or off. */
    m->specular = !model->shines                           ? 0
                  : model->facets || !(from->specular > 0) ? within(from->specular, 1)
                                                           : 1;
    m->repeat[0] = m->scene->replicate_u, m->repeat[1] = m->scene->replicate_v;
}

/* Letters, digits and _, not beginning with a digit: names of USD prims and of MaterialX's elements. */
static void add_identifier(WrText *text, const char *name)
{
    if (*name >= '0' && *name <= '9') wr_text_add(text, "_");
    for (; *name; name++) {
        const bool plain = (*name >= '0' && *name <= '9') || (*name >= 'A' && *name <= 'Z') ||
                           (*name >= 'a' && *name <= 'z');
        wr_text_add_n(text, plain ? name : "_", 1);
    }
}

static void gather(const WrMaterialRequest *order, Material *m)
{
    const char *object = order->count ? order->maps[0].options.object : NULL;
    const int index = object ? wr_scene_object_find(order->document->scene, object) : -1;
    *m = (Material){ .order = order, .scene = order->document->scene };
    if (index >= 0) m->scene = wr_scene_object(order->document->scene, index);
    take_numbers(m);
    add_identifier(&m->id, order->name);
    for (int i = 0; i < order->count; i++) give_map(m, i);
    if (!m->scene->colour) return;
    const WrTextureSample *laid = &m->scene->colour_laid;
    WrText name = { 0 };
    wr_text_addf(&name, "%s_colour.png", order->name);
    m->picture = name.data;
    m->textures[WR_ROLE_COLOUR] = (Texture){ .file = m->picture,
                                             .channels = 3,
                                             .scale = 1,
                                             .repeat = { laid->own ? laid->ru : m->repeat[0],
                                                         laid->own ? laid->rv : m->repeat[1] },
                                             .map = -1 };
}

/* A scale of 1 and a bias of 0: the texel itself. */
static bool is_plain(const Texture *t)
{
    return fabs(t->scale - 1) <= 0 && fabs(t->bias) <= 0;
}

static void add_numbers(WrText *text, const double *x, int count)
{
    for (int i = 0; i < count; i++) {
        if (i) wr_text_add(text, ", ");
        wr_text_add_number(text, x[i] + 0.0);
    }
}

static const char *unit_of(const Material *m)
{
    return m->scene->cell.mm ? "millimetres" : "scene units";
}

/* ---- MaterialX ---- */

static void add_xml(WrText *out, const char *text)
{
    for (; *text; text++) {
        const char *escape = *text == '<'   ? "&lt;"
                             : *text == '>' ? "&gt;"
                             : *text == '&' ? "&amp;"
                             : *text == '"' ? "&quot;"
                                            : NULL;
        if (escape) wr_text_add(out, escape);
        else wr_text_add_n(out, text, 1);
    }
}

static void mtlx_numbers(WrText *out, const char *name, const char *type, const double *x,
                         int count)
{
    wr_text_addf(out, "      <input name=\"%s\" type=\"%s\" value=\"", name, type);
    add_numbers(out, x, count);
    wr_text_add(out, "\" />\n");
}

static void mtlx_link(WrText *out, const char *name, const char *type, const char *node)
{
    wr_text_addf(out, "      <input name=\"%s\" type=\"%s\" nodename=\"%s\" />\n", name, type,
                 node);
}

/* A node of two inputs: the node before, and numbers. The names are ROLE_OPERATION. */
static void mtlx_arithmetic(WrText *out, const char *operation, const char *type, char node[64],
                            const char *role, const double *x, int count)
{
    char name[64];
    snprintf(name, sizeof name, "%s_%s", role, operation);
    wr_text_addf(out, "    <%s name=\"%s\" type=\"%s\">\n", operation, name, type);
    mtlx_link(out, "in1", type, node);
    mtlx_numbers(out, "in2", type, x, count);
    wr_text_addf(out, "    </%s>\n", operation);
    snprintf(node, 64, "%s", name);
}

static const char *image_type(const Texture *t, WrMaterialRole role)
{
    static const char *const types[] = { "float", "vector2", "vector3", "vector4" };
    return role == WR_ROLE_COLOUR ? "color3"
                                  : types[(t->channels < 1   ? 1
                                           : t->channels > 4 ? 4
                                                             : t->channels) -
                                          1];
}

static void mtlx_image(WrText *out, const Texture *t, WrMaterialRole role, char node[64])
{
    const char *type = image_type(t, role);
    snprintf(node, 64, "%s_image", role_names[role]);
    wr_text_addf(out, "    <tiledimage name=\"%s\" type=\"%s\">\n", node, type);
    wr_text_addf(out, "      <input name=\"file\" type=\"filename\" colorspace=\"%s\" value=\"",
                 role == WR_ROLE_COLOUR ? "srgb_texture" : "none");
    add_xml(out, t->file);
    wr_text_add(out, "\" />\n");
    mtlx_numbers(out, "uvtiling", "vector2", t->repeat, 2);
    wr_text_add(out, "    </tiledimage>\n");
    if (role == WR_ROLE_COLOUR || role == WR_ROLE_NORMAL || t->channels == 1) return;
    wr_text_addf(out, "    <extract name=\"%s_channel\" type=\"float\">\n", role_names[role]);
    mtlx_link(out, "in", type, node);
    wr_text_addf(out,
                 "      <input name=\"index\" type=\"integer\" value=\"%d\" />\n    </extract>\n",
                 t->channel);
    snprintf(node, 64, "%s_channel", role_names[role]);
}

/* 1 - y of the codes is green up: the sum of (x, 1 - y, z). */
static void mtlx_normal(WrText *out, const Texture *t, char node[64])
{
    static const double turn[3] = { 1, -1, 1 }, lift[3] = { 0, 1, 0 };
    if (t->green_down) {
        mtlx_arithmetic(out, "multiply", "vector3", node, "normal", turn, 3);
        mtlx_arithmetic(out, "add", "vector3", node, "normal", lift, 3);
    }
    wr_text_add(out, "    <normalmap name=\"normal_map\" type=\"vector3\">\n");
    mtlx_link(out, "in", "vector3", node);
    wr_text_add(out, "    </normalmap>\n");
    snprintf(node, 64, "normal_map");
}

static const char *output_type(WrMaterialRole role)
{
    return role == WR_ROLE_NORMAL ? "vector3" : role == WR_ROLE_COLOUR ? "color3" : "float";
}

/* The nodes of one texture, and the graph's output. The heights' scale belongs to the displacement: here is the offset
   alone, x + bias / scale. */
static void mtlx_texture(const Material *m, WrText *out, WrMaterialRole role)
{
    const Texture *t = &m->textures[role];
    const char *name = role_names[role];
    const double offset = t->bias / t->scale;
    char node[64];
    mtlx_image(out, t, role, node);
    if (role == WR_ROLE_NORMAL) mtlx_normal(out, t, node);
    else if (role == WR_ROLE_COLOUR)
        mtlx_arithmetic(out, "multiply", "color3", node, name, m->colour, 3);
    else if (role != WR_ROLE_HEIGHT && !is_plain(t)) {
        mtlx_arithmetic(out, "multiply", "float", node, name, &t->scale, 1);
        mtlx_arithmetic(out, "add", "float", node, name, &t->bias, 1);
    } else if (isfinite(offset) && fabs(offset) > 0) {
        mtlx_arithmetic(out, "add", "float", node, name, &offset, 1);
    }
    wr_text_addf(out, "    <output name=\"%s_out\" type=\"%s\" nodename=\"%s\" />\n", name,
                 output_type(role), node);
}

/* An input of a shader: the graph's output, or numbers. */
static void mtlx_input(const Material *m, WrText *out, const char *name, WrMaterialRole role,
                       const double *x, int count)
{
    if (!uses(m, role)) {
        if (x) mtlx_numbers(out, name, output_type(role), x, count);
        return;
    }
    wr_text_addf(out,
                 "      <input name=\"%s\" type=\"%s\" nodegraph=\"NG_%s\" output=\"%s_out\" />\n",
                 name, output_type(role), wr_text_get(&m->id), role_names[role]);
}

static void mtlx_shaders(const Material *m, WrText *out)
{
    static const double one = 1;
    const char *id = wr_text_get(&m->id);
    wr_text_addf(out, "  <standard_surface name=\"SR_%s\" type=\"surfaceshader\">\n", id);
    mtlx_numbers(out, "base", "float", &one, 1);
    mtlx_input(m, out, "base_color", WR_ROLE_COLOUR, m->colour, 3);
    mtlx_numbers(out, "specular", "float", &m->specular, 1);
    mtlx_input(m, out, "specular_roughness", WR_ROLE_ROUGHNESS, &m->roughness, 1);
    mtlx_numbers(out, "specular_IOR", "float", &m->ior, 1);
    mtlx_input(m, out, "metalness", WR_ROLE_METALNESS, &m->metalness, 1);
    mtlx_input(m, out, "normal", WR_ROLE_NORMAL, NULL, 0);
    wr_text_add(out, "  </standard_surface>\n");
    if (uses(m, WR_ROLE_HEIGHT)) {
        wr_text_addf(out, "  <!-- heights in %s -->\n", unit_of(m));
        wr_text_addf(out, "  <displacement name=\"DS_%s\" type=\"displacementshader\">\n", id);
        mtlx_input(m, out, "displacement", WR_ROLE_HEIGHT, NULL, 0);
        mtlx_numbers(out, "scale", "float", &m->textures[WR_ROLE_HEIGHT].scale, 1);
        wr_text_add(out, "  </displacement>\n");
    }
    wr_text_addf(out, "  <surfacematerial name=\"M_%s\" type=\"material\">\n", id);
    wr_text_addf(
        out, "      <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"SR_%s\" />\n",
        id);
    if (uses(m, WR_ROLE_HEIGHT))
        wr_text_addf(out,
                     "      <input name=\"displacementshader\" type=\"displacementshader\" "
                     "nodename=\"DS_%s\" />\n",
                     id);
    wr_text_add(out, "  </surfacematerial>\n");
}

static bool mtlx_write(const Material *m, WrText *out, WrText *bin, WrError *err)
{
    (void)bin, (void)err;
    wr_text_add(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                     "<materialx version=\"1.38\" colorspace=\"lin_rec709\">\n");
    if (m->uses) {
        wr_text_addf(out, "  <nodegraph name=\"NG_%s\">\n", wr_text_get(&m->id));
        for (int role = 0; role < WR_ROLES; role++)
            if (uses(m, (WrMaterialRole)role)) mtlx_texture(m, out, (WrMaterialRole)role);
        wr_text_add(out, "  </nodegraph>\n");
    }
    mtlx_shaders(m, out);
    wr_text_add(out, "</materialx>\n");
    return true;
}

static const char *mtlx_refuses(const Material *m, int role)
{
    (void)m;
    return role == WR_ROLE_OCCLUSION ? "the standard surface has no input for it" : NULL;
}

static bool mtlx_check(const Material *m, const char *path, const WrText *out, WrError *err)
{
    (void)m;
    XML_Parser parser = XML_ParserCreate(NULL);
    const bool good = XML_Parse(parser, out->data, (int)out->length, 1) == XML_STATUS_OK;
    if (!good) wr_fail(err, "%s: is not XML: %s", path, XML_ErrorString(XML_GetErrorCode(parser)));
    XML_ParserFree(parser);
    return good;
}

/* ---- USD ---- */

/* @./NAME@; a name that contains @ stands between three of them, where \@@@ is three. */
static void usd_asset(WrText *out, const char *file)
{
    const char *ends = strchr(file, '@') ? "@@@" : "@";
    wr_text_addf(out, "%s./", ends);
    for (; *file; file++) {
        if (strncmp(file, "@@@", 3) == 0) {
            wr_text_add(out, "\\@@@");
            file += 2;
        } else {
            wr_text_add_n(out, file, 1);
        }
    }
    wr_text_add(out, ends);
}

static void usd_numbers(WrText *out, const char *type, const char *name, const double *x, int count)
{
    wr_text_addf(out, "            %s inputs:%s = %s", type, name, count > 1 ? "(" : "");
    add_numbers(out, x, count);
    wr_text_add(out, count > 1 ? ")\n" : "\n");
}

static void usd_link(const Material *m, WrText *out, const char *type, const char *name,
                     const char *shader, const char *output)
{
    wr_text_addf(out, "            %s inputs:%s.connect = </%s/Material/%s.outputs:%s>\n", type,
                 name, wr_text_get(&m->id), shader, output);
}

static void usd_shader(WrText *out, const char *name, const char *id)
{
    wr_text_addf(
        out, "        def Shader \"%s\"\n        {\n            uniform token info:id = \"%s\"\n",
        name, id);
}

/* Its (u,v): those of the mesh, repeated; and the picture, as codes become numbers. */
static void usd_texture(const Material *m, WrText *out, WrMaterialRole role)
{
    const Texture *t = &m->textures[role];
    static const double one[4] = { 1, 1, 1, 1 };
    const double turn = t->green_down ? -1 : 1;
    const double normal[2][4] = { { 2, 2 * turn, 2, 1 }, { -1, -turn, -1, 0 } };
    const double value[2][4] = { { t->scale, t->scale, t->scale, 1 },
                                 { t->bias, t->bias, t->bias, 0 } };
    const double tint[4] = { m->colour[0], m->colour[1], m->colour[2], 1 };
    char place[40];
    snprintf(place, sizeof place, "%s_repeat", role_names[role]);
    usd_shader(out, place, "UsdTransform2d");
    usd_link(m, out, "float2", "in", "st", "result");
    usd_numbers(out, "float2", "scale", t->repeat, 2);
    wr_text_add(out, "            float2 outputs:result\n        }\n\n");
    usd_shader(out, role_names[role], "UsdUVTexture");
    wr_text_add(out, "            asset inputs:file = ");
    usd_asset(out, t->file);
    wr_text_addf(out, "\n            token inputs:sourceColorSpace = \"%s\"\n",
                 role == WR_ROLE_COLOUR ? "sRGB" : "raw");
    wr_text_add(out, "            token inputs:wrapS = \"repeat\"\n"
                     "            token inputs:wrapT = \"repeat\"\n");
    usd_link(m, out, "float2", "st", place, "result");
    usd_numbers(out, "float4", "scale",
                role == WR_ROLE_NORMAL   ? normal[0]
                : role == WR_ROLE_COLOUR ? tint
                : is_plain(t)            ? one
                                         : value[0],
                4);
    usd_numbers(out, "float4", "bias", role == WR_ROLE_NORMAL ? normal[1] : value[1], 4);
    if (role == WR_ROLE_NORMAL || role == WR_ROLE_COLOUR)
        wr_text_add(out, "            float3 outputs:rgb\n");
    else wr_text_addf(out, "            float outputs:%c\n", "rgba"[t->channel & 3]);
    wr_text_add(out, "        }\n\n");
}

static void usd_input(const Material *m, WrText *out, const char *type, const char *name,
                      WrMaterialRole role, const double *x, int count)
{
    const char output[2] = { "rgba"[m->textures[role].channel & 3], '\0' };
    if (uses(m, role))
        usd_link(m, out, type, name, role_names[role],
                 role == WR_ROLE_NORMAL || role == WR_ROLE_COLOUR ? "rgb" : output);
    else if (x) usd_numbers(out, type, name, x, count);
}

static void usd_surface(const Material *m, WrText *out)
{
    usd_shader(out, "surface", "UsdPreviewSurface");
    usd_input(m, out, "color3f", "diffuseColor", WR_ROLE_COLOUR, m->colour, 3);
    usd_input(m, out, "float", "roughness", WR_ROLE_ROUGHNESS, &m->roughness, 1);
    usd_input(m, out, "float", "metallic", WR_ROLE_METALNESS, &m->metalness, 1);
    usd_numbers(out, "float", "ior", &m->ior, 1);
    usd_input(m, out, "normal3f", "normal", WR_ROLE_NORMAL, NULL, 0);
    usd_input(m, out, "float", "occlusion", WR_ROLE_OCCLUSION, NULL, 0);
    usd_input(m, out, "float", "displacement", WR_ROLE_HEIGHT, NULL, 0);
    wr_text_add(out, "            token outputs:surface\n"
                     "            token outputs:displacement\n        }\n\n");
}

/* A rectangle of the repeated cells, so that a viewer shows the material. */
static void usd_mesh(const Material *m, WrText *out)
{
    const double w = m->scene->cell.w * m->repeat[0] / 2, h = m->scene->cell.h * m->repeat[1] / 2;
    const double corners[4][3] = { { -w, -h, 0 }, { w, -h, 0 }, { w, h, 0 }, { -w, h, 0 } };
    const int ends[2] = { 0, 2 };
    wr_text_add(out, "    def Mesh \"Sheet\" (\n"
                     "        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {\n"
                     "        uniform bool doubleSided = 1\n"
                     "        int[] faceVertexCounts = [4]\n"
                     "        int[] faceVertexIndices = [0, 1, 2, 3]\n");
    wr_text_addf(out, "        rel material:binding = </%s/Material>\n", wr_text_get(&m->id));
    for (int k = 0; k < 2; k++) {
        wr_text_add(out, k ? "        point3f[] points = [" : "        float3[] extent = [");
        for (int i = 0; i < (k ? 4 : 2); i++) {
            wr_text_add(out, i ? ", (" : "(");
            add_numbers(out, corners[k ? i : ends[i]], 3);
            wr_text_add(out, ")");
        }
        wr_text_add(out, "]\n");
    }
    wr_text_add(out, "        normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] (\n"
                     "            interpolation = \"vertex\"\n        )\n"
                     "        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (\n"
                     "            interpolation = \"vertex\"\n        )\n"
                     "        uniform token subdivisionScheme = \"none\"\n    }\n\n");
}

static bool usda_write(const Material *m, WrText *out, WrText *bin, WrError *err)
{
    const char *id = wr_text_get(&m->id);
    (void)bin, (void)err;
    wr_text_addf(out,
                 "#usda 1.0\n(\n    defaultPrim = \"%s\"\n    metersPerUnit = %s\n"
                 "    upAxis = \"Z\"\n)\n\ndef Xform \"%s\" (\n    kind = \"component\"\n)\n{\n",
                 id, m->scene->cell.mm ? "0.001" : "1", id);
    usd_mesh(m, out);
    wr_text_add(out, "    def Material \"Material\"\n    {\n");
    wr_text_addf(out,
                 "        token outputs:surface.connect = </%s/Material/surface.outputs:surface>\n",
                 id);
    if (uses(m, WR_ROLE_HEIGHT))
        wr_text_addf(out,
                     "        token outputs:displacement.connect = "
                     "</%s/Material/surface.outputs:displacement>\n",
                     id);
    wr_text_add(out, "\n");
    usd_surface(m, out);
    if (m->uses) {
        usd_shader(out, "st", "UsdPrimvarReader_float2");
        wr_text_add(out, "            string inputs:varname = \"st\"\n"
                         "            float2 outputs:result\n        }\n\n");
    }
    for (int role = 0; role < WR_ROLES; role++)
        if (uses(m, (WrMaterialRole)role)) usd_texture(m, out, (WrMaterialRole)role);
    wr_text_add(out, "    }\n}\n");
    return true;
}

static const char *usda_refuses(const Material *m, int role)
{
    (void)m, (void)role;
    return NULL;
}

/* ---- glTF ---- */

/* A relative URI: bytes except letters, digits and -._~ are percent-encoded (RFC 3986, 2.3). */
static void add_uri(WrText *out, const char *name, const char *ending)
{
    wr_text_add(out, "\"");
    for (const char *c = name; *c; c++) {
        const bool plain = (*c >= '0' && *c <= '9') || (*c >= 'A' && *c <= 'Z') ||
                           (*c >= 'a' && *c <= 'z') || strchr("-._~", *c);
        if (plain) wr_text_add_n(out, c, 1);
        else wr_text_addf(out, "%%%02X", (unsigned)(unsigned char)*c);
    }
    wr_text_addf(out, "%s\"", ending);
}

/* Roughness is in green, metalness in blue, occlusion in red. A grey picture has the same in all. */
static const char *gltf_refuses(const Material *m, int role)
{
    const Texture *t = &m->textures[role];
    const Texture *rough = &m->textures[WR_ROLE_ROUGHNESS];
    const bool grey = t->channels == 1, level = m->metalness <= 0;
    char ending[16];
    wr_path_ending(t->file, ending);
    if (role == WR_ROLE_HEIGHT) return "glTF has no displacement";
    if (strcmp(ending, "png") != 0 && strcmp(ending, "jpg") != 0 && strcmp(ending, "jpeg") != 0)
        return "glTF reads PNG and JPEG only";
    if (role == WR_ROLE_NORMAL && t->green_down) return "glTF needs +Y normals";
    if (role == WR_ROLE_OCCLUSION && (t->channel != 0 || !is_plain(t)))
        return "glTF needs it in red";
    if (role == WR_ROLE_ROUGHNESS && (!is_plain(t) || !(t->channel == 1 || (grey && level))))
        return "glTF needs it in green, with metalness in blue";
    if (role == WR_ROLE_METALNESS && (t->channel != 2 || !rough->file || rough->channel != 1 ||
                                      strcmp(rough->file, t->file) != 0))
        return "glTF needs it in blue, with roughness in green";
    return NULL;
}

/* The first role in use whose texture is of the same file. */
static WrMaterialRole first_of_file(const Material *m, WrMaterialRole role)
{
    for (int k = 0; k < (int)role; k++)
        if (uses(m, (WrMaterialRole)k) && strcmp(m->textures[k].file, m->textures[role].file) == 0)
            return (WrMaterialRole)k;
    return role;
}

/* Index of the image and the texture of a role that is the first of its file. */
static int gltf_index(const Material *m, WrMaterialRole role)
{
    int index = 0;
    for (int k = 0; k < (int)role; k++)
        index +=
            uses(m, (WrMaterialRole)k) && first_of_file(m, (WrMaterialRole)k) == (WrMaterialRole)k;
    return index;
}

/* TEXCOORD_0 is (r u, 1 - r v) with the cells' repeat r. A picture of another repeat r' needs the scale s = r'/r, and along
   v the offset 1 - s, as in glb.c. */
static void gltf_texture(const Material *m, WrText *out, const char *name, WrMaterialRole role)
{
    const Texture *t = &m->textures[role];
    if (!uses(m, role)) return;
    wr_text_addf(out, ",\"%s\":{\"index\":%d", name, gltf_index(m, first_of_file(m, role)));
    const double s[2] = { t->repeat[0] / m->repeat[0], t->repeat[1] / m->repeat[1] };
    const double offset[2] = { 0, 1 - s[1] };
    if (fabs(s[0] - 1) > 0 || fabs(s[1] - 1) > 0) {
        wr_text_add(out, ",\"extensions\":{\"KHR_texture_transform\":{\"scale\":[");
        add_numbers(out, s, 2);
        wr_text_add(out, "],\"offset\":[");
        add_numbers(out, offset, 2);
        wr_text_add(out, "]}}");
    }
    wr_text_add(out, "}");
}

static void gltf_material(const Material *m, WrText *out)
{
    const double factor[4] = { m->colour[0], m->colour[1], m->colour[2], 1 };
    const double roughness = uses(m, WR_ROLE_ROUGHNESS) ? 1 : m->roughness;
    const double metalness = uses(m, WR_ROLE_METALNESS) ? 1 : m->metalness;
    wr_text_add(out, ",\"materials\":[{\"name\":");
    wr_text_add_json_string(out, m->order->name);
    wr_text_add(out, ",\"pbrMetallicRoughness\":{\"baseColorFactor\":[");
    add_numbers(out, factor, 4);
    wr_text_add(out, "],\"metallicFactor\":");
    wr_text_add_number(out, metalness);
    wr_text_add(out, ",\"roughnessFactor\":");
    wr_text_add_number(out, roughness);
    gltf_texture(m, out, "baseColorTexture", WR_ROLE_COLOUR);
    gltf_texture(m, out, "metallicRoughnessTexture", WR_ROLE_ROUGHNESS);
    wr_text_add(out, "}");
    gltf_texture(m, out, "normalTexture", WR_ROLE_NORMAL);
    gltf_texture(m, out, "occlusionTexture", WR_ROLE_OCCLUSION);
    if (fabs(m->ior - 1.5) > 0) {
        wr_text_add(out, ",\"extensions\":{\"KHR_materials_ior\":{\"ior\":");
        wr_text_add_number(out, m->ior);
        wr_text_add(out, "}}");
    }
    if (wr_surfaces[m->scene->shape.kind]->open) wr_text_add(out, ",\"doubleSided\":true");
    wr_text_add(out, "}]");
}

/* An image and a texture for each file in use, in the order of roles. */
static void gltf_pictures(const Material *m, WrText *out)
{
    int count = 0;
    if (!m->uses) return;
    wr_text_add(out, ",\"samplers\":[{\"wrapS\":10497,\"wrapT\":10497}],\"images\":[");
    for (int role = 0; role < WR_ROLES; role++) {
        if (!uses(m, (WrMaterialRole)role) ||
            first_of_file(m, (WrMaterialRole)role) != (WrMaterialRole)role)
            continue;
        wr_text_add(out, count++ ? ",{\"uri\":" : "{\"uri\":");
        add_uri(out, m->textures[role].file, "");
        wr_text_add(out, "}");
    }
    wr_text_add(out, "],\"textures\":[");
    for (int k = 0; k < count; k++)
        wr_text_addf(out, "%s{\"sampler\":0,\"source\":%d}", k ? "," : "", k);
    wr_text_add(out, "]");
}

static void gltf_extensions(const Material *m, WrText *out)
{
    bool moved = false;
    const bool ior = fabs(m->ior - 1.5) > 0;
    for (int role = 0; role < WR_ROLES; role++)
        for (int k = 0; k < 2 && uses(m, (WrMaterialRole)role); k++)
            moved |= fabs(m->textures[role].repeat[k] / m->repeat[k] - 1) > 0;
    if (!moved && !ior) return;
    wr_text_addf(out, "\"extensionsUsed\":[%s%s%s],", moved ? "\"KHR_texture_transform\"" : "",
                 moved && ior ? "," : "", ior ? "\"KHR_materials_ior\"" : "");
}

/* On the scene's object; a plane is a rectangle of the repeated cells, in metres. */
static bool gltf_write(const Material *m, WrText *out, WrText *bin, WrError *err)
{
    const WrCellSize *cell = &m->scene->cell;
    const double metres = cell->mm ? 0.001 : 1;
    const double size[2] = { metres * cell->w * m->repeat[0], metres * cell->h * m->repeat[1] };
    const bool plane = m->scene->shape.kind == WR_SURFACE_plane;
    wr_text_add(out, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Wrinkle\"},");
    gltf_extensions(m, out);
    if (!wr_gltf_add_model(m->scene, plane ? size : NULL, m->repeat, out, bin, err)) return false;
    gltf_pictures(m, out);
    gltf_material(m, out);
    wr_text_addf(out, ",\"buffers\":[{\"byteLength\":%zu,\"uri\":", bin->length);
    add_uri(out, m->order->name, ".bin");
    wr_text_add(out, "}]}\n");
    return true;
}

static bool gltf_check(const Material *m, const char *path, const WrText *out, WrError *err)
{
    WrGltfMaterial read;
    (void)out;
    if (!wr_gltf_read_material(path, NULL, &read, err)) return false;
    bool same = (read.normal >= 0) == uses(m, WR_ROLE_NORMAL) &&
                (read.facets >= 0) == uses(m, WR_ROLE_ROUGHNESS) &&
                (read.base >= 0) == uses(m, WR_ROLE_COLOUR);
    for (int c = 0; c < 3; c++) same = same && fabs(read.colour[c] - m->colour[c]) <= 0;
    return same || wr_fail(err, "%s: does not read back as it was written", path);
}

/* ---- formats and files ---- */

const WrMaterialFormat wr_material_formats[WR_MATERIAL_FORMATS] = {
    { "mtlx", "MaterialX", mtlx_refuses, mtlx_write, mtlx_check },
    { "usda", "USD preview surface", usda_refuses, usda_write, NULL },
    { "gltf", "glTF", gltf_refuses, gltf_write, gltf_check },
};

static const char *format_word(const void *ctx, int i)
{
    (void)ctx;
    return i < WR_MATERIAL_FORMATS        ? wr_material_formats[i].name
           : i == WR_MATERIAL_FORMATS     ? "all"
           : i == WR_MATERIAL_FORMATS + 1 ? "none"
                                          : NULL;
}

bool wr_material_formats_parse(const char *text, unsigned *formats, WrError *err)
{
    unsigned found = 0;
    for (const char *at = text;; at++) {
        char word[24], what[60];
        const size_t length = strcspn(at, ",");
        int i = 0;
        snprintf(word, sizeof word, "%.*s", (int)(length < 23 ? length : 23), at);
        while (format_word(NULL, i) && strcmp(format_word(NULL, i), word) != 0) i++;
        if (!format_word(NULL, i)) {
            snprintf(what, sizeof what, "material '%s'", word);
            return wr_fail_word(err, what, word, format_word, NULL);
        }
        if (i < WR_MATERIAL_FORMATS) found |= 1u << i;
        if (i == WR_MATERIAL_FORMATS) found = (1u << WR_MATERIAL_FORMATS) - 1;
        at += length;
        if (!*at) break;
    }
    *formats = found;
    return true;
}

/* "FILE: MaterialX with normal, height (texels 0..1 are 0..0.3 millimetres); left out: FILE: why, ..." */
static void report(const Material *m, const WrMaterialFormat *format, const char *path,
                   WrText *list)
{
    const char *before = " with ";
    char number[WR_NUMBER_SIZE];
    wr_text_addf(list, "%s: %s", path, format->title);
    for (int role = 0; role < WR_ROLES; role++) {
        const Texture *t = &m->textures[role];
        if (!uses(m, (WrMaterialRole)role)) continue;
        wr_text_addf(list, "%s%s", before, role_names[role]);
        before = ", ";
        if (role != WR_ROLE_HEIGHT) continue;
        wr_text_addf(list, " (texels 0..1 are %s",
                     wr_number_print_float((float)(t->bias + 0.0), number));
        wr_text_addf(list, "..%s %s)", wr_number_print_float((float)(t->bias + t->scale), number),
                     unit_of(m));
    }
    before = "; left out: ";
    for (int i = 0; i < m->order->count; i++)
        if (m->why[i]) {
            wr_text_addf(list, "%s%s: %s", before, m->order->maps[i].file, m->why[i]);
            before = ", ";
        }
    for (int role = 0; role < WR_ROLES; role++)
        if (m->textures[role].file && !uses(m, (WrMaterialRole)role)) {
            wr_text_addf(list, "%s%s of %s: %s", before, role_names[role], m->textures[role].file,
                         format->refuses(m, role));
            before = ", ";
        }
    wr_text_add(list, "\n");
}

/* Writes the file under the name and an ending. */
static bool put_file(const Material *m, const char *ending, const WrText *bytes, WrText *path,
                     WrError *err)
{
    WrText name = { 0 };
    wr_text_addf(&name, "%s.%s", m->order->name, ending);
    char *full = wr_path_join(m->order->folder, wr_text_get(&name));
    wr_text_clear(path);
    wr_text_add(path, full);
    const bool good = wr_file_write(full, wr_text_get(bytes), bytes->length, err);
    wr_free(full);
    wr_text_fini(&name);
    return good;
}

static bool write_format(Material *m, const WrMaterialFormat *format, WrText *list, WrError *err)
{
    WrText out = { 0 }, bin = { 0 }, path = { 0 };
    const double began = wr_clock_seconds();
    m->uses = 0;
    for (int role = 0; role < WR_ROLES; role++)
        if (m->textures[role].file && !format->refuses(m, role)) m->uses |= 1u << role;
    bool good = format->write(m, &out, &bin, err) &&
                (!bin.length || put_file(m, "bin", &bin, &path, err)) &&
                put_file(m, format->name, &out, &path, err);
    const char *last = good ? wr_file_group_last() : NULL;
    if (good && format->check) good = format->check(m, last ? last : wr_text_get(&path), &out, err);
    if (good) report(m, format, wr_text_get(&path), list);
    if (good && m->order->receipts)
        wr_receipts_add(m->order->receipts, wr_text_get(&path), format->name, NULL, began);
    wr_text_fini(&out);
    wr_text_fini(&bin);
    wr_text_fini(&path);
    return good;
}

static bool write_colour(const Material *m, WrText *list, WrError *err)
{
    char *bytes = NULL, *path = wr_path_join(m->order->folder, m->picture);
    size_t length;
    const bool good = wr_gltf_colour_png(m->scene->colour, &bytes, &length, err) &&
                      wr_file_write(path, bytes, length, err);
    if (good) wr_text_addf(list, "%s: colours, sRGB\n", path);
    wr_free(bytes);
    wr_free(path);
    return good;
}

bool wr_material_files_write(const WrMaterialRequest *order, unsigned formats, WrText *list,
                             WrError *err)
{
    Material m;
    if (!formats) return true;
    if (!wr_text_is_utf8(order->name))
        return wr_fail(err, "name '%.60s': is not UTF-8, which material files need: give another",
                       order->name);
    gather(order, &m);
    bool good = !m.picture || write_colour(&m, list, err);
    for (int i = 0; i < WR_MATERIAL_FORMATS && good; i++)
        if (formats >> i & 1) good = write_format(&m, &wr_material_formats[i], list, err);
    wr_free(m.picture);
    wr_text_fini(&m.id);
    return good;
}
