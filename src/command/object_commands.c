/* Commands for the objects of a scene: object, ground. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/session.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/camera_control.h"
#include "scene/objects.h"
#include "scene/param.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include <math.h>
#include <string.h>

/* ---- a table of an object ---- */

/* `object set table=FILE`: a table of the object's own, stored as a hidden layer. It can therefore be painted,
   masked, undone and saved like any layer, and a document stays one file with one table size. */

static void note_size(WrSession *session, const char *path, int width, int height,
                      const WrField *like)
{
    if (width == wr_field_width(like) && height == wr_field_height(like)) return;
    wr_session_note(session, "%s is %dx%d: resampled to the table's %dx%d", path, width, height,
                    wr_field_width(like), wr_field_height(like));
}

/* The heights as a one-channel picture. */
static WrImage *image_of(const WrField *field, WrError *err)
{
    const int width = wr_field_width(field), height = wr_field_height(field);
    WrImage *image = wr_image_new(width, height, 1, err);
    if (!image) return NULL;
    image->type = WR_PIXEL_F32;
    wr_field_read(field, 0, 0, width, height, image->data, (size_t)width);
    return image;
}

/* The composite of an OpenRaster document, whose pictures are for display only. */
static WrField *heights_of_ora(WrSession *session, const char *path, const WrField *like,
                               WrError *err)
{
    const WrSessionOptions options = { .pool = session->options.pool,
                                       .note = session->options.note,
                                       .note_ctx = session->options.note_ctx };
    WrSession *other = wr_session_new(&options);
    WrImage *image = NULL;
    WrField *made = NULL;
    if (wr_session_load(other, path, err))
        image = image_of(wr_document_composite(other->state.document, session->options.pool), err);
    if (image) {
        note_size(session, path, image->width, image->height, like);
        made = wr_import_heights(image, wr_field_width(like), wr_field_height(like),
                                 wr_field_wrap_u(like), wr_field_wrap_v(like), err);
    }
    wr_image_free(image);
    wr_session_free(other);
    return made;
}

/* In a document that is an EXR file, the first part is the composite, as in any picture. */
static WrField *heights_of_picture(WrSession *session, const char *path, const WrField *like,
                                   WrError *err)
{
    const WrImageRequest wish = { 0 };
    WrImageRows *rows = wr_image_rows_open(path, &wish, err);
    if (!rows) return NULL;
    const WrImage *head = wr_image_rows_head(rows);
    const int width = head->width, height = head->height;
    WrField *made = wr_session_heights_of(session, rows, path, true, like, err);
    if (made) note_size(session, path, width, height, like);
    wr_image_rows_close(rows);
    return made;
}

/* "shell" of "pictures/shell.exr"; "shell 2" if there is a layer of that name. The caller frees it. */
static char *layer_name(const WrDocument *document, const char *path)
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    if (length > WR_LAYER_NAME_MAX - 8) length = WR_LAYER_NAME_MAX - 8;
    while (length > 0 && ((unsigned char)base[length] & 0xC0) == 0x80) length--;
    WrText text = { 0 };
    for (int number = 1;; number++) {
        int same = 0;
        wr_text_clear(&text);
        wr_text_add_n(&text, base, length);
        if (number > 1) wr_text_addf(&text, " %d", number);
        for (int i = 0; i < document->layer_count; i++)
            same += strcmp(document->layers[i].name, wr_text_get(&text)) == 0;
        if (same == 0) return text.data;
    }
}

/* `object set table=`: load the file as a hidden layer, and make it the table of the scene's active object. */
static bool object_take_table(WrSession *session, WrCall *call, WrScene *scene, WrError *err)
{
    const char *name = wr_call_arg(call, "table")->text;
    WrDocument *document = session->state.document;
    if (!wr_call_given(call, "table")) {
        if (!wr_call_given(call, "sha256")) return true;
        return wr_fail(err, "sha256= needs table=");
    }
    if (wr_call_given(call, "layer"))
        return wr_fail(err, "give table= or layer=, not both: the file of table= becomes a layer");
    if (document->layer_count == WR_LAYERS_MAX)
        return wr_fail(err, "a document has up to %d layers", WR_LAYERS_MAX);
    const WrField *like = document->layers[0].heights;
    char *path = wr_session_input_path(session, name);
    WrField *heights = NULL;
    if (wr_session_check_sha256(call, path, err))
        heights = wr_ora_recognise(path) ? heights_of_ora(session, path, like, err)
                                         : heights_of_picture(session, path, like, err);
    wr_free(path);
    if (!heights) return false;
    char *own = layer_name(document, name);
    WrLayer layer = wr_layer_make(own, like);
    wr_field_free(layer.heights);
    wr_field_free(layer.cover);
    layer.heights = heights;
    layer.cover = NULL;
    layer.visible = false;
    wr_document_insert(document, document->layer_count, layer);
    document->active = document->layer_count - 1;
    wr_free(scene->layer);
    scene->layer = own;
    return true;
}

/* ---- The command object: adding, choosing, placing and removing objects of a scene ---- */

enum {
    FORM_ADD,
    FORM_COPY,
    FORM_CHOOSE,
    FORM_SET,
    FORM_HIDE,
    FORM_SHOW,
    FORM_REMOVE,
    OBJECT_FORMS
};

#define ALL "all"
#define OWN WR_OWN_TURN

/* ---- as lines ---- */

/* Position, size and so on; the size as one number or three. */
static void print_placed(const WrScene *object, WrText *text)
{
    const WrSceneParam *p;
    for (int i = 0; (p = wr_scene_param("object", "set", i)) != NULL; i++) {
        wr_text_addf(text, " %s=", p->name);
        if (p == &wr_scene_params[WR_SCENE_PARAM_SIZE] && v3_len(object->sizes) > 0)
            wr_scene_print_vec(object->sizes, text);
        else wr_scene_print_value(p, object, text);
    }
}

/* All settings of the object except its name. */
static void print_settings(const WrScene *object, WrText *text)
{
    print_placed(object, text);
    wr_text_add(text, " turn=");
    if (object->posed) wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_ROTATE], object, text);
    else wr_text_add(text, OWN);
    wr_text_add(text, " layer=");
    wr_text_add_word(text, object->layer ? object->layer : ALL);
    wr_text_add(text, "\n");
}

void wr_print_object(const WrScene *scene, int i, WrText *text)
{
    const WrScene *object = wr_scene_object(scene, i);
    char buffer[WR_OBJECT_LABEL];
    const char *label = wr_scene_object_label(scene, i, buffer);
    wr_text_add(text, i > 0 ? "object add " : "object set");
    if (i > 0) wr_text_add_word(text, label);
    if (i == 0 && object->name) {
        wr_text_add(text, " name=");
        wr_text_add_word(text, object->name);
    }
    print_settings(object, text);
}

/* A scene's only object, whose rotation is a view: nothing while it is as in an empty document. */
static void print_object(const WrScene *scene, WrText *text)
{
    const bool plain = v3_len(scene->at) == 0 && scene->size == 1 && v3_len(scene->sizes) == 0 &&
                       !scene->hidden && !scene->still;
    if (scene->other_count > 0 || (plain && !scene->name && !scene->layer)) return;
    wr_text_add(text, "object set");
    if (scene->name) {
        wr_text_add(text, " name=");
        wr_text_add_word(text, scene->name);
    }
    print_placed(scene, text);
    wr_text_add(text, " layer=");
    wr_text_add_word(text, scene->layer ? scene->layer : ALL);
    wr_text_add(text, "\n");
}

void wr_print_chosen(const WrScene *scene, WrText *text)
{
    char buffer[WR_OBJECT_LABEL];
    if (scene->other_count == 0 || scene->chosen == scene->other_count) return;
    wr_text_add(text, "object choose ");
    wr_text_add_word(text, wr_scene_object_label(scene, scene->chosen, buffer));
    wr_text_add(text, "\n");
}

/* ---- finding ---- */

/* The object that the line names, else the active one. */
static bool find(const WrScene *scene, const WrCall *call, int *index, WrError *err)
{
    const WrArg *name = wr_call_arg(call, "NAME");
    char buffer[WR_OBJECT_LABEL], last[WR_OBJECT_LABEL];
    *index = name->given ? wr_scene_object_find(scene, name->text) : scene->chosen;
    if (*index >= 0) return true;
    const int count = wr_scene_object_count(scene);
    if (count == 1)
        return wr_fail(err, "no object \"%s\": the only one is \"%s\"", name->text,
                       wr_scene_object_label(scene, 0, buffer));
    return wr_fail(err, "no object \"%s\": there are %d, from \"%s\" to \"%s\"", name->text, count,
                   wr_scene_object_label(scene, 0, buffer),
                   wr_scene_object_label(scene, count - 1, last));
}

/* Check that object `own` (-1: a new one) may have that name. */
static bool check_name(const WrScene *scene, int own, const char *name, WrError *err)
{
    const int other = wr_scene_object_find(scene, name);
    if (other < 0 || other == own) return true;
    return wr_fail(err, "an object \"%s\" already exists: choose another name", name);
}

/* ---- changing ---- */

static bool take_layer(const WrSession *session, const WrCall *call, WrScene *scene, WrError *err)
{
    const char *word = wr_call_given(call, "layer") ? wr_call_arg(call, "layer")->text : NULL;
    int index;
    if (!word) return true;
    char *layer = NULL;
    if (strcmp(word, ALL) != 0) {
        if (!session->loading && !wr_session_find_layer(session, word, &index, err)) return false;
        layer = wr_strdup(session->loading ? word : session->state.document->layers[index].name);
    }
    wr_free(scene->layer);
    scene->layer = layer;
    return true;
}

static bool take_turn(const WrCall *call, WrScene *scene, WrError *err)
{
    const WrArg *turn = wr_call_arg(call, "turn");
    return !turn->given || wr_scene_take_turn(turn->text, scene, err);
}

/* One size for all axes, or three; the largest of three is the object's size. */
static bool take_size(const WrCall *call, WrScene *scene, WrError *err)
{
    const WrArg *arg = wr_call_arg(call, "size");
    if (!arg->given) return true;
    const bool three = arg->counts[0] == 3;
    const WrVec3 s = { arg->numbers[0], arg->numbers[1], arg->numbers[2] };
    const double largest = three ? fmax(fabs(s.x), fmax(fabs(s.y), fabs(s.z))) : arg->numbers[0];
    if (!(largest >= 1e-9))
        return wr_fail(err, "size=%g: %s must be 1e-9 or more", largest,
                       three ? "the largest of the three, without its sign," : "one alone");
    const bool plain = s.x == s.y && s.y == s.z && s.x > 0;
    scene->size = largest;
    scene->sizes = three && !plain ? s : (WrVec3){ 0 };
    return true;
}

/* Apply the line to the active object. Ownership of the scene passes to the session. */
static bool put(WrSession *session, WrCall *call, const char *name, WrScene *scene, WrError *err)
{
    if (wr_call_given(call, "turn") && scene->other_count == 0 && !session->loading) {
        wr_scene_free(scene);
        return wr_fail(err, "turn= needs several objects; `rotate` rotates the only one");
    }
    if (!take_layer(session, call, scene, err) || !object_take_table(session, call, scene, err) ||
        !take_turn(call, scene, err)) {
        wr_scene_free(scene);
        return false;
    }
    if (name) {
        wr_free(scene->name);
        scene->name = wr_strdup(name);
    }
    wr_scene_take(call, "set", scene);
    if (!take_size(call, scene, err)) {
        wr_scene_free(scene);
        return false;
    }
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_add(WrSession *session, WrCall *call, bool copy, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    const char *name = wr_call_arg(call, "NAME")->text;
    if (wr_scene_object_count(scene) == WR_OBJECTS_MAX)
        return wr_fail(err, "a scene holds at most %d objects", WR_OBJECTS_MAX);
    if (!check_name(scene, -1, name, err)) return false;
    return put(session, call, name, wr_scene_add_object(scene, copy), err);
}

static bool run_set(WrSession *session, WrCall *call, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    const char *name = wr_call_given(call, "name") ? wr_call_arg(call, "name")->text : NULL;
    if (name && !check_name(scene, scene->chosen, name, err)) return false;
    return put(session, call, name, wr_scene_clone(scene), err);
}

static bool run_remove(WrSession *session, const WrCall *call, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    int index;
    if (!find(scene, call, &index, err)) return false;
    if (wr_scene_object_count(scene) == 1)
        return wr_fail(err, "the last object stays: a scene has at least one");
    wr_session_replace_scene(session, wr_scene_remove_object(scene, index));
    return true;
}

static bool run_choose(WrSession *session, const WrCall *call, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    int index;
    if (!find(scene, call, &index, err)) return false;
    wr_session_replace_scene(session, wr_scene_choose(scene, index));
    return true;
}

static bool run_hide(WrSession *session, const WrCall *call, bool hidden, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    int index;
    if (!find(scene, call, &index, err)) return false;
    wr_session_replace_scene(session, wr_scene_hide(scene, index, hidden));
    return true;
}

static bool run_object(WrSession *session, WrCall *call, WrError *err)
{
    switch (call->form) {
    case FORM_ADD: return run_add(session, call, false, err);
    case FORM_COPY: return run_add(session, call, true, err);
    case FORM_CHOOSE: return run_choose(session, call, err);
    case FORM_SET: return run_set(session, call, err);
    case FORM_HIDE:
    case FORM_SHOW: return run_hide(session, call, call->form == FORM_HIDE, err);
    default: return run_remove(session, call, err);
    }
}

/* ---- the row ---- */

WR_ROWS(object_forms);
static const struct {
    const char *name, *help;
    bool named;    /* NAME must be given */
    bool renames;  /* name= */
    bool settings; /* position, size and so on */
} object_forms[] = {
    [WR_ROW(FORM_ADD)] = { "add",
                           "add an object, a plane as in an empty document, and make it active",
                           true, .settings = true },
    [WR_ROW(FORM_COPY)] = { "copy", "duplicate the active object, and make the copy active", true,
                            .settings = true },
    [WR_ROW(FORM_CHOOSE)] = { "choose", "make an object active; commands apply to it", true },
    [WR_ROW(FORM_SET)] = { "set", "change the active object; only given arguments change",
                           .renames = true, .settings = true },
    [WR_ROW(FORM_HIDE)] = { "hide", "hide an object; NAME left out, the active one" },
    [WR_ROW(FORM_SHOW)] = { "show", "show a hidden object" },
    [WR_ROW(FORM_REMOVE)] = { "remove", "remove an object" },
};
WR_ROWS_END(object_forms, OBJECT_FORMS);

static void take_three(WrArgSpec *size)
{
    size->type = WR_ARG_TUPLE;
    size->components = 3;
    size->counts = TUPLE_OF(1) | TUPLE_OF(3);
    size->low = -size->high;
    size->shape = "s or x,y,z";
    size->help = "scale of the surface; heights scale with it. Three numbers: along its axes; "
                 "below 0 mirrored, 0 flat";
}

static bool form_object(int i, WrForm *out)
{
    static const WrArgSpec name = {
        PLACE("NAME"), .type = WR_ARG_NAME,
        .help = "name of the object; if optional and left out, the active one"
    };
    static const WrArgSpec rename = { .name = "name", .type = WR_ARG_NAME, .help = "new name" };
    static const WrArgSpec turn = { .name = "turn",
                                    .type = WR_ARG_TEXT,
                                    .shape = "x,y,z or " OWN,
                                    .help = "rotation about the world's x, then y, then z axis, in "
                                            "degrees; own: the surface's default pose" };
    static const WrArgSpec layer = { .name = "layer",
                                     .type = WR_ARG_LAYER,
                                     .help = "layer whose heights are its table; " ALL
                                             ": the composite" };
    static const WrArgSpec table = { .name = "table",
                                     .type = WR_ARG_PATH,
                                     .help =
                                         "a document or picture whose heights are its table; it is "
                                         "added as a layer, hidden for all other objects" };
    static const WrArgSpec sha256 = {
        .name = "sha256",
        .type = WR_ARG_SHA256,
        .help = "SHA-256 of the table's file; a file with other content is an error"
    };
    int count = 0;
    if (i >= OBJECT_FORMS) return false;
    *out = (WrForm){ .name = object_forms[i].name, .help = object_forms[i].help };
    if (!object_forms[i].renames) {
        out->args[count] = name;
        out->args[count++].required = object_forms[i].named;
    } else {
        out->args[count++] = rename;
    }
    if (!object_forms[i].settings) return true;
    const int first = count;
    count += wr_scene_args("object", "set", out->args + count);
    for (int k = first; k < count; k++)
        if (strcmp(out->args[k].name, "size") == 0) take_three(&out->args[k]);
    out->args[count++] = turn;
    out->args[count++] = layer;
    out->args[count++] = table;
    out->args[count++] = sha256;
    return true;
}

const WrCommand wr_command_object = {
    .name = "object",
    .kind = WR_CLASS_SCENE,
    .form_word = "WHAT",
    .form = form_object,
    .run = run_object,
    .print = print_object,
    .in_object = true,
    .of_object = true,
    .help = "add, select and change objects of the scene",
    .details =
        "Each object has its own surface, bump, replication, material, pictures, position and "
        "size; lights, camera and dials belong to the scene. An object without a name is called "
        "object 1, object 2 and so on. `object set turn=` rotates one of several objects, `camera` "
        "moves the viewpoint; the turntable turns all objects about the world's y axis.",
    .example = "object add bricks at=1.2,0,0 size=0.8"
};

/* ---- The command ground ---- */

/* The command ground: a floor below the objects; an ordinary object of the scene that does not turn with the
   others. */

#define GROUND "ground"
#define WIDE 12.0 /* times the radius of the objects on it */
#define ENDLESS 2 /* index of a plane parameter */

enum { FORM_ON, FORM_OFF, GROUND_FORMS };

/* A flat, matt plane with its normal up. It has no table, so that painting on other objects does not show on it. */
static WrScene *new_ground(const WrScene *scene)
{
    WrScene *made = wr_scene_add_object(scene, false);
    wr_free(made->name);
    made->name = wr_strdup(GROUND);
    made->still = true;
    made->posed = true;
    made->rotate_deg = (WrVec3){ -90, 0, 0 };
    made->bump = WR_BUMP_NONE;
    made->material.specular = 0;
    made->shape.value[ENDLESS] = 1;
    made->material.colour = (WrVec3){ 0.4, 0.4, 0.4 };
    made->size = WIDE * wr_scene_bounding_radius(scene, false);
    return made;
}

/* Prints nothing: the object's own lines hold the result. */
static void print_nothing(const WrScene *scene, WrText *text)
{
    (void)scene;
    (void)text;
}

/* Set whether the floor reaches the horizon. A new floor with a size ends there. */
static bool set_end(const WrCall *call, bool fresh, WrScene *made, WrError *err)
{
    double *endless = &made->shape.value[ENDLESS];
    if (!wr_call_given(call, "endless")) {
        if (fresh && wr_call_given(call, "size")) *endless = 0;
        return true;
    }
    if (made->shape.kind != WR_SURFACE_plane)
        return wr_fail(err, "endless=: the ground is a %s now; only a plane can be endless",
                       wr_surfaces[made->shape.kind]->name);
    *endless = wr_call_choice(call, "endless");
    return true;
}

static bool run_on(const WrCall *call, const WrScene *scene, int index, WrScene **out, WrError *err)
{
    double height;
    if (wr_call_given(call, "height")) height = wr_call_number(call, "height");
    else if (!wr_camera_control_lowest(scene, &height, err)) return false;
    WrScene *made = index < 0 ? new_ground(scene) : wr_scene_choose(scene, index);
    made->at.y = height;
    made->hidden = false;
    if (wr_call_given(call, "size")) made->size = wr_call_number(call, "size");
    if (!set_end(call, index < 0, made, err)) {
        wr_scene_free(made);
        return false;
    }
    if (wr_call_given(call, "colour")) {
        const double *rgb = wr_call_arg(call, "colour")->numbers;
        made->material.colour = (WrVec3){ rgb[0], rgb[1], rgb[2] };
    }
    *out = wr_scene_choose(made, scene->chosen);
    wr_scene_free(made);
    return true;
}

static bool run_ground(WrSession *session, WrCall *call, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    const int index = wr_scene_object_find(scene, GROUND);
    WrScene *made;
    if (index >= 0 && !wr_scene_object(scene, index)->still)
        return wr_fail(err, "an object is called \"" GROUND "\" and turns with the others: `object "
                            "choose " GROUND "`, then `object set name=` gives it another name");
    if (call->form == FORM_ON) {
        if (index < 0 && wr_scene_object_count(scene) == WR_OBJECTS_MAX)
            return wr_fail(err, "a scene holds at most %d objects", WR_OBJECTS_MAX);
        if (!run_on(call, scene, index, &made, err)) return false;
    } else {
        if (index < 0) return wr_fail(err, "there is no ground: `ground on` adds one");
        if (wr_scene_object_count(scene) == 1)
            return wr_fail(err, "the last object stays: a scene has at least one");
        made = wr_scene_remove_object(scene, index);
    }
    wr_session_replace_scene(session, made);
    return true;
}

WR_ROWS(ground_forms);
static const WrForm ground_forms[] = {
    [WR_ROW(
        FORM_ON)] = { .name = "on",
                      .help = "add the ground, or change it",
                      .args = { { .name = "height",
                                  .type = WR_ARG_NUMBER,
                                  .low = -1e9,
                                  .high = 1e9,
                                  .unit = "scene units",
                                  .help =
                                      "its y; left out, the lowest point of the visible objects" },
                                { .name = "size",
                                  .type = WR_ARG_NUMBER,
                                  .low = 1e-9,
                                  .high = 1e9,
                                  .unit = "scene units",
                                  .help = "length of its sides; left out, unchanged, at first 12 "
                                          "times the radius of the objects on it" },
                                { .name = "colour",
                                  .type = WR_ARG_TUPLE,
                                  .components = 3,
                                  .shape = "r,g,b",
                                  .high = 1e6,
                                  .help = "colour, linear; left out, unchanged" },
                                { .name = "endless",
                                  .type = WR_ARG_CHOICE,
                                  .words = wr_off_on,
                                  .help = "on: it continues to the horizon, where it fades; left "
                                          "out, unchanged, at first on unless size= is given" } } },
    [WR_ROW(FORM_OFF)] = { .name = "off", .help = "remove the ground" },
};
WR_ROWS_END(ground_forms, GROUND_FORMS);

WR_FORMS(form_ground, ground_forms)

const WrCommand wr_command_ground = {
    .name = "ground",
    .kind = WR_CLASS_SCENE,
    .form_word = "WHAT",
    .form = form_ground,
    .run = run_ground,
    .print = print_nothing,
    .help = "add a floor under the objects",
    .details = "The ground is an object named " GROUND
               ": a horizontal plane that extends to the horizon and does not turn with the "
               "turntable (`object set still=on`). The active object does not change; make the "
               "ground active to give it another surface or relief. It is invisible from below.",
    .example = "ground on colour=0.3,0.25,0.2"
};
