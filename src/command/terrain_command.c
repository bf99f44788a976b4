/* The command `surface terrain`: a surface whose form is a height picture, or a layer of the document. Changes of the
   layer update the form. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/objects.h"
#include "surface/patches.h"
#include "surface/terrain.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

static const float *row_of_image(const void *ctx, int j, float *room)
{
    const WrImage *image = ctx;
    const size_t channels = (size_t)image->channels, w = (size_t)image->width;
    const float *from = image->data + (size_t)j * w * channels;
    for (size_t i = 0; i < w; i++) room[i] = wr_image_luma(from + i * channels, (int)channels);
    return room;
}

static const float *row_of_field(const void *ctx, int j, float *room)
{
    const WrField *field = ctx;
    wr_field_read(field, 0, j, wr_field_width(field), 1, room, (size_t)wr_field_width(field));
    return room;
}

static WrTriangles *made_of(WrTerrain terrain, const WrShape *shape, WrError *err)
{
    float(*points)[48];
    int columns, rows;
    terrain.a = shape->value[0], terrain.b = shape->value[1];
    terrain.height = shape->value[2];
    terrain.cells = (int)shape->value[3];
    if (!wr_terrain_points(&terrain, &points, &columns, &rows, err)) return NULL;
    WrTriangles *made =
        wr_patches_new((const float(*)[48])points, columns * rows, WR_PATCH_SPLIT, err);
    wr_free(points);
    return made;
}

/* Elevations in metres on a surface a few units wide make a needle. The note suggests the height scale for half as
   tall as wide. */
static void note_needle(WrSession *session, const char *path, const WrImage *image,
                        const WrShape *shape)
{
    const size_t channels = (size_t)image->channels,
                 count = (size_t)image->width * (size_t)image->height;
    float low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        const float z = wr_image_luma(image->data + i * channels, (int)channels);
        if (z < low) low = z;
        if (z > high) high = z;
    }
    const double span = (double)high - (double)low, side = fmin(shape->value[0], shape->value[1]);
    if (!(fabs(shape->value[2]) * span > 5 * side)) return;
    wr_session_note(
        session,
        "%s: its values go from %g to %g, so height=%g makes a ground %g tall and %g wide; "
        "height=%.2g makes it half as tall as wide",
        path, (double)low, (double)high, shape->value[2], fabs(shape->value[2]) * span, side,
        0.5 * side / span);
}

WrTriangles *wr_terrain_read(WrSession *session, const char *path, const WrShape *shape,
                             WrError *err)
{
    const WrImageRequest wish = { .elevation = true };
    WrImage *image = wr_image_read_wish(path, &wish, err);
    if (!image) return NULL;
    wr_session_note_read(session, path, image);
    note_needle(session, path, image, shape);
    const WrTerrain terrain = {
        .row = row_of_image, .ctx = image, .w = image->width, .h = image->height
    };
    WrTriangles *made = made_of(terrain, shape, err);
    wr_image_free(image);
    return made;
}

void wr_terrain_note(WrSession *session, const char *path, const WrTriangles *mesh)
{
    const WrPatches *set = mesh->patches;
    wr_session_note(session, "%s: %d x %d patches in %d triangles", path, (int)set->columns,
                    (int)set->rows, (int)mesh->triangle_count);
}

/* ---- from a layer -------------------------------------------------------------------------------- */

/* Form and bump use different layers: the form layer is hidden from the composite, so that its heights do not count
   twice. */
static bool hide_layer(WrSession *session, int index, const WrScene *scene, WrError *err)
{
    const WrScene *before = session->state.document->scene;
    WrLayer *layer = &session->state.document->layers[index];
    if (scene->layer && strcmp(scene->layer, layer->name) == 0)
        return wr_fail(err, "the object wears that layer: its form must be another");
    if (before->form_layer && strcmp(before->form_layer, layer->name) == 0) return true;
    if (!layer->visible) return true;
    layer->visible = false;
    wr_session_note(session, "layer %d is hidden: it is the ground now, and no bump", index + 1);
    return true;
}

bool wr_terrain_names_layer(const WrCall *call)
{
    return wr_call_given(call, "layer");
}

bool wr_terrain_take_layer(WrSession *session, WrCall *call, WrScene *scene, WrError *err)
{
    const char *word = wr_call_arg(call, "layer")->text, *name = word;
    int index;
    if (wr_call_given(call, "file"))
        return wr_fail(err, "file= and layer= do not go together: the form is of one of them");
    if (!session->loading) {
        if (!wr_session_find_layer(session, word, &index, err) ||
            !hide_layer(session, index, scene, err))
            return false;
        name = session->state.document->layers[index].name;
    } else if (session->embedded_mesh) { /* until the layer's heights are used */
        WrTriangles *mesh = wr_scene_mesh_from_image(session->embedded_mesh, scene->chosen, err);
        if (!mesh) return false;
        wr_scene_set_triangles(scene, mesh, NULL, NULL);
    }
    scene->form_layer = wr_strdup(name);
    return true;
}

/* True if the layer that object i takes its form from exists and has changed; *index is that layer. */
static bool lags(const WrDocument *document, int i, int *index)
{
    const WrScene *object = wr_scene_object(document->scene, i);
    if (!object->form_layer || object->shape.kind != WR_SURFACE_terrain) return false;
    *index = wr_layer_named(document, object->form_layer);
    return *index >= 0 &&
           (!object->triangles || object->form_key != wr_layer_key(document, *index));
}

static bool take_form(WrSession *session, WrScene *object, int index, WrError *err)
{
    const WrDocument *document = session->state.document;
    WrField *heights = wr_document_layer_alone(document, index, session->options.pool);
    const WrTerrain terrain = { .row = row_of_field,
                                .ctx = heights,
                                .w = wr_field_width(heights),
                                .h = wr_field_height(heights) };
    WrTriangles *made = made_of(terrain, &object->shape, err);
    wr_field_free(heights);
    if (!made) return false;
    wr_scene_set_triangles(object, made, NULL, NULL);
    object->form_key = wr_layer_key(document, index);
    return true;
}

/* Rebuild object i's form, its colours or both. */
static bool follow_object(WrSession *session, int i, int form, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    WrScene *object = wr_scene_clone(wr_scene_object(scene, i)), *all = object;
    const bool good = (form < 0 || take_form(session, object, form, err)) &&
                      (!wr_height_colormap_lags(session, object) ||
                       wr_height_colormap_make(session, object, err));
    if (!good) {
        wr_scene_free(object);
        return false;
    }
    if (i != scene->chosen) {
        all = wr_scene_clone(scene);
        wr_scene_set_object(all, i, object);
    }
    wr_session_replace_scene(session, all);
    return true;
}

bool wr_session_follow(WrSession *session, WrError *err)
{
    for (int i = 0; i < wr_scene_object_count(session->state.document->scene); i++) {
        const WrScene *object = wr_scene_object(session->state.document->scene, i);
        int form = -1;
        if (!lags(session->state.document, i, &form)) form = -1;
        if (form < 0 && !wr_height_colormap_lags(session, object)) continue;
        if (!follow_object(session, i, form, err)) return false;
    }
    return true;
}

void wr_form_terrain(WrArgSpec *args)
{
    args[0] = (WrArgSpec){ .name = "file",
                           .type = WR_ARG_PATH,
                           .help = "a picture, black low and white high; what is made of it is "
                                   "saved inside the document" };
    args[2] = (WrArgSpec){ .name = "layer",
                           .type = WR_ARG_TEXT,
                           .shape = "NAME",
                           .help = "instead: its name or number, bottom 1; the layer is the "
                                   "ground's form from now on, as it is painted, and hidden as "
                                   "a bump" };
}
