/* The command object: adding, choosing, placing and removing objects of a scene. */
#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "scene/objects.h"
#include "scene/param.h"

#include <math.h>
#include <string.h>

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
        return wr_fail(err, "there is no object \"%s\"; the only one is \"%s\"", name->text,
                       wr_scene_object_label(scene, 0, buffer));
    return wr_fail(err, "there is no object \"%s\"; there are %d, from \"%s\" to \"%s\"",
                   name->text, count, wr_scene_object_label(scene, 0, buffer),
                   wr_scene_object_label(scene, count - 1, last));
}

/* Check that object `own` (-1: a new one) may have that name. */
static bool check_name(const WrScene *scene, int own, const char *name, WrError *err)
{
    const int other = wr_scene_object_find(scene, name);
    if (other < 0 || other == own) return true;
    return wr_fail(err, "there is an object \"%s\" already: each needs a name of its own", name);
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
        return wr_fail(err, "turn= is for one of several objects; `rotate` turns the only one");
    }
    if (!take_layer(session, call, scene, err) ||
        !wr_object_take_table(session, call, scene, err) || !take_turn(call, scene, err)) {
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
    [WR_ROW(FORM_ADD)] = { "add", "one more, a plane as in an empty document; it is chosen", true,
                           .settings = true },
    [WR_ROW(FORM_COPY)] = { "copy", "one more, like the chosen one; it is chosen then", true,
                            .settings = true },
    [WR_ROW(FORM_CHOOSE)] = { "choose", "commands are about this one from now on", true },
    [WR_ROW(FORM_SET)] = { "set", "only what is given changes, of the chosen one", .renames = true,
                           .settings = true },
    [WR_ROW(FORM_HIDE)] = { "hide", "leave it out of pictures; NAME left out, the chosen one" },
    [WR_ROW(FORM_SHOW)] = { "show", "bring it back into pictures" },
    [WR_ROW(FORM_REMOVE)] = { "remove", "take one away" },
};
WR_ROWS_END(object_forms, OBJECT_FORMS);

static void take_three(WrArgSpec *size)
{
    size->type = WR_ARG_TUPLE;
    size->components = 3;
    size->counts = TUPLE_OF(1) | TUPLE_OF(3);
    size->low = -size->high;
    size->shape = "s or x,y,z";
    size->help =
        "times its surface's own size; heights grow with it. Three: along its axes; below 0 "
        "mirrored, 0 flat";
}

static bool form_object(int i, WrForm *out)
{
    static const WrArgSpec name = { PLACE("NAME"), .type = WR_ARG_NAME,
                                    .help =
                                        "of the object; where it may be left out, the chosen one" };
    static const WrArgSpec rename = { .name = "name", .type = WR_ARG_NAME, .help = "its new name" };
    static const WrArgSpec turn = { .name = "turn",
                                    .type = WR_ARG_TEXT,
                                    .shape = "x,y,z or " OWN,
                                    .help =
                                        "degrees about the world's x, then y, then z axis; own: "
                                        "the pose in which its surface first shows itself" };
    static const WrArgSpec layer = { .name = "layer",
                                     .type = WR_ARG_LAYER,
                                     .help = "whose heights alone are its table; " ALL
                                             ": all layers as they are joined" };
    static const WrArgSpec table = {
        .name = "table",
        .type = WR_ARG_PATH,
        .help = "a document or a picture whose heights are to be its table: "
                "it becomes a layer, hidden from all others"
    };
    static const WrArgSpec sha256 = { .name = "sha256",
                                      .type = WR_ARG_SHA256,
                                      .help =
                                          "of the table's file: another content is then an error" };
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
    .help = "several objects in one scene",
    .details = "Each has surface, bump, replication, material, colour picture, place and size of "
               "its own; lights, camera and dials are the scene's. An object without a name is "
               "called object 1, object 2 and so on. Of several objects `object set turn=` turns "
               "one, and `camera` looks from elsewhere; the turntable turns all about the "
               "world's y axis.",
    .example = "object add bricks at=1.2,0,0 size=0.8"
};
