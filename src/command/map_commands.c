/* Texture maps of the object: colour and normals. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/texture_args.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "document/document_file.h"
#include "base/hash.h"
#include "scene/texture_sample.h"
#include "scene/normal_map.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#define LOOK 16384 /* pixels between two checks for cancellation */

/* ---- colour ---- */

/* Linear RGB, or one grey channel, without alpha; 8-bit and 16-bit values are decoded from sRGB. */
static WrImage *linear_colour(const WrImage *from, WrError *err)
{
    int channels = from->channels < 3 ? 1 : 3;
    WrImage *to = wr_image_new(from->width, from->height, channels, err);
    if (!to) return NULL;
    to->type = WR_PIXEL_F32;
    size_t pixels = (size_t)from->width * (size_t)from->height;
    bool decode = from->type != WR_PIXEL_F32;
    for (size_t i = 0; i < pixels; i++) {
        if (i % LOOK == 0 && wr_progress_stopped()) {
            wr_image_free(to);
            wr_fail(err, "cancelled");
            return NULL;
        }
        for (int c = 0; c < channels; c++) {
            float x = from->data[i * (size_t)from->channels + (size_t)c];
            if (decode) x = wr_srgb_decode(x);
            to->data[i * (size_t)channels + (size_t)c] = x > 0 ? x : 0;
        }
    }
    return to;
}

static void print_colour_line(const WrScene *scene, bool named, WrText *text)
{
    if (!scene->colour || scene->colouring.count > 0) return;
    wr_text_add(text, "colour");
    wr_print_laid(&scene->colour_laid, named, text);
    wr_text_add(text, "\n");
}

static void print_colour(const WrScene *scene, WrText *text)
{
    print_colour_line(scene, true, text);
}

static void print_colour_content(const WrScene *scene, WrText *text)
{
    print_colour_line(scene, !*scene->colour_laid.sha256, text);
}

/* Change the settings of the present picture by a line without a file. */
static bool change_colour(WrSession *session, const WrCall *call, WrError *err)
{
    static const char *const of_file[] = { "layer", "part", "sha256", NULL };
    const WrScene *now = session->state.document->scene;
    if (!now->colour || now->colouring.count > 0)
        return wr_fail(err, "the object has no colour picture: name a file");
    if (!wr_refuse_without(call, of_file, "only a line that names a file takes", err)) return false;
    WrScene *scene = wr_scene_clone(now);
    wr_take_repeat(call, &scene->colour_laid);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_colour(WrSession *session, WrCall *call, WrError *err)
{
    static const char *const of_colour[] = { "sha256", "repeat", "layer", "part", NULL };
    const WrArg *file = wr_call_arg(call, "FILE|off");
    const char *name = file->given ? file->text : NULL;
    const bool off = name && strcmp(name, "off") == 0;
    if (!name) return change_colour(session, call, err);
    if (off && !wr_refuse_without(call, of_colour, "off takes no", err)) return false;
    WrImage *image = off ? NULL : wr_find_laid(session, call, name, WR_OBJECT_COLOUR, err);
    WrImage *colour = image ? linear_colour(image, err) : NULL;
    wr_image_free(image);
    if (!off && !colour) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_drop_colour(scene);
    scene->colour = colour;
    wr_take_laid(call, off ? NULL : name, &scene->colour_laid);
    wr_session_replace_scene(session, scene);
    return true;
}

/* ---- normals ---- */

static const char *const spaces[] = { "tangent", "object", NULL };
static const char *const greens[] = { "auto", "up", "down", NULL };
static const char *const channel_counts[] = { "auto", "2", "3", NULL };

static void print_normals_line(const WrScene *scene, bool named, WrText *text)
{
    const WrNormalMap *map = &scene->normals;
    if (!map->image) return;
    wr_text_add(text, "normalmap");
    wr_print_laid(&map->laid, named, text);
    wr_text_addf(text, " space=%s green=%s", spaces[map->object],
                 greens[map->green_down ? WR_GREEN_DOWN : WR_GREEN_UP]);
    if (!map->object)
        wr_text_addf(text, " frame=%s channels=%d", wr_normal_frame_names[map->frame],
                     map->channels);
    wr_text_add(text, " strength=");
    wr_text_add_number(text, map->strength);
    wr_text_add(text, "\n");
}

static void print_normals(const WrScene *scene, WrText *text)
{
    print_normals_line(scene, true, text);
}

static void print_normals_content(const WrScene *scene, WrText *text)
{
    print_normals_line(scene, !*scene->normals.laid.sha256, text);
}

static void note_codes(WrText *text, const WrImage *file, const WrNormalTold *told)
{
    const double last = wr_pixel_last(file->type);
    wr_text_addf(text, "%dx%d, %d channels of ", file->width, file->height, told->channels);
    if (last > 0) wr_text_addf(text, "%d bits", last > 255 ? 16 : 8);
    else
        wr_text_addf(text, "floats, %s",
                     told->own ? "the vectors' own (coding=signed)"
                               : "coded in 0..1 (coding=unit)");
    if (told->channels == 2) wr_text_add(text, ", z rebuilt");
    if (told->centred) wr_text_addf(text, "; code %d stands for 0", (int)(last + 1) / 2);
}

/* Note the interpretation of a normal map and possible faults in it. */
static void note_normals(WrSession *session, const char *name, const WrImage *file, WrGreen asked,
                         bool labelled, const WrNormalTold *told)
{
    WrText text = { 0 };
    note_codes(&text, file, told);
    wr_text_addf(&text, "; green %s%s", told->green_down ? "down" : "up",
                 asked != WR_GREEN_AUTO ? ""
                 : labelled             ? ", as its label says"
                 : told->undecided ? ", undecided: its slopes fit either; green=down takes it so"
                                   : ", found from its slopes");
    if (told->away)
        wr_text_addf(&text, "; %lld texels that look away were brought to the horizon",
                     (long long)told->away);
    if (told->converted)
        wr_text_add(&text, "; its mean is that of a picture that went through an sRGB conversion: "
                           "normals are data, and would be bent");
    wr_session_note(session, "%s: %s", name, wr_text_get(&text));
    wr_text_fini(&text);
}

/* Read the normal map of a file as the line states. */
static WrImage *read_normals(WrSession *session, const WrCall *call, const char *name,
                             const WrImage *file, WrNormalMap *map, WrError *err)
{
    const int channels = wr_call_choice(call, "channels");
    const WrGreen asked = (WrGreen)wr_call_choice(call, "green");
    const WrCoding coding = (WrCoding)wr_call_choice(call, "coding");
    const bool labelled = file->label.green != 0;
    WrGreen green = asked;
    WrNormalTold told;
    if (green == WR_GREEN_AUTO && labelled)
        green = file->label.green < 0 ? WR_GREEN_DOWN : WR_GREEN_UP;
    WrImage *image =
        map->object
            ? wr_normal_map_read_object(file, green == WR_GREEN_DOWN, coding, &told, err)
            : wr_normal_map_read(file, green, channels ? channels + 1 : 0, coding, &told, err);
    if (!image) return NULL;
    map->channels = told.channels;
    map->green_down = told.green_down;
    note_normals(session, name, file, map->object ? WR_GREEN_UP : asked, labelled, &told);
    return image;
}

/* Set the normal map of a line with a file; settings of the earlier map are not kept. */
static bool take_normals(WrSession *session, WrCall *call, const char *name, WrNormalMap *map,
                         WrError *err)
{
    const bool object = wr_call_choice(call, "space") == 1;
    if (object && wr_call_given(call, "channels"))
        return wr_fail(err, "channels= is of space=tangent: the object's axes take all three");
    if (object && wr_call_given(call, "frame"))
        return wr_fail(err, "frame= is of space=tangent: the object's axes are their own");
    WrImage *file = wr_find_laid(session, call, name, WR_OBJECT_NORMALS, err), *image = NULL;
    map->object = object;
    map->frame = WR_FRAME_AUTO;
    map->strength = 1;
    if (file && session->loading) {
        map->green_down = wr_call_choice(call, "green") == WR_GREEN_DOWN;
        map->channels = wr_call_choice(call, "channels") == 1 ? 2 : 3;
        image = wr_normal_map_keep(file, object, err);
    } else if (file) {
        image = read_normals(session, call, name, file, map, err);
    }
    wr_image_free(file);
    if (!image) return false;
    wr_image_free(map->image);
    map->image = image;
    wr_take_laid(call, name, &map->laid);
    return true;
}

/* Change the meaning of the green channel. */
static bool change_green(const WrCall *call, WrNormalMap *map, WrError *err)
{
    const int green = wr_call_choice(call, "green");
    if (!wr_call_given(call, "green")) return true;
    if (green == WR_GREEN_AUTO)
        return wr_fail(err, "green=auto: only a line that names a file takes it");
    if ((green == WR_GREEN_DOWN) == map->green_down) return true;
    WrImage *turned = wr_normal_map_turned(map->image, err);
    if (!turned) return false;
    wr_image_free(map->image);
    map->image = turned;
    map->green_down = !map->green_down;
    return true;
}

/* Convert the present vectors to another space; vectors below the tangent plane are moved to its horizon. */
static bool change_space(WrSession *session, const WrCall *call, WrNormalMap *map, WrError *err)
{
    const bool object = wr_call_choice(call, "space") == 1;
    int64_t away;
    if (!wr_call_given(call, "space") || object == map->object) return true;
    WrImage *taken =
        object ? wr_image_share(map->image) : wr_normal_map_raised(map->image, &away, err);
    if (!taken) return false;
    if (!object && away)
        wr_session_note(session, "%lld texels that look away were brought to the horizon",
                        (long long)away);
    wr_image_free(map->image);
    map->image = taken;
    map->object = object;
    map->frame = WR_FRAME_AUTO;
    return true;
}

/* Change the settings of the present map by a line without a file. */
static bool change_normals(WrSession *session, const WrCall *call, WrNormalMap *map, WrError *err)
{
    static const char *const of_file[] = { "channels", "coding", "layer", "part", "sha256", NULL };
    if (!map->image) return wr_fail(err, "the object has no normal map: name a file");
    if (!wr_refuse_without(call, of_file, "only a line that names a file takes", err)) return false;
    if (!change_green(call, map, err) || !change_space(session, call, map, err)) return false;
    if (map->object && wr_call_given(call, "frame"))
        return wr_fail(err, "frame=: this map is of the object's axes");
    wr_take_repeat(call, &map->laid);
    return true;
}

static bool run_normals(WrSession *session, WrCall *call, WrError *err)
{
    static const char *const of_map[] = { "space",  "frame",    "green",  "channels",
                                          "coding", "strength", "repeat", "layer",
                                          "part",   "sha256",   NULL };
    const WrArg *file = wr_call_arg(call, "FILE|off");
    const char *name = file->given ? file->text : NULL;
    const bool off = name && (strcmp(name, "off") == 0 || strcmp(name, "none") == 0);
    if (off && !wr_refuse_without(call, of_map, "off takes no", err)) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrNormalMap *map = &scene->normals;
    bool good = true;
    if (off) {
        wr_image_free(map->image);
        wr_texture_sample_fini(&map->laid);
        *map = (WrNormalMap){ 0 };
    } else {
        good = name ? take_normals(session, call, name, map, err)
                    : change_normals(session, call, map, err);
    }
    if (good && wr_call_given(call, "frame"))
        map->frame = (WrNormalFrame)wr_call_choice(call, "frame");
    if (good && wr_call_given(call, "strength")) map->strength = wr_call_number(call, "strength");
    if (good) wr_session_replace_scene(session, scene);
    else wr_scene_free(scene);
    return good;
}

/* ---- rows ---- */

static const char *const off_words[] = { "off", NULL }, *const none_words[] = { "off", "none",
                                                                                NULL };

static const WrArgSpec args_colour[] = {
    { .name = "FILE|off",
      .type = WR_ARG_PATH,
      .positional = true,
      .words = off_words,
      .help = "a picture that is laid over u and v, or off (a file of that name is ./off). Left "
              "out: the one that is there, of which repeat may change" },
    WR_ARGS_REPEAT,
    WR_ARGS_OF_FILE,
    WR_ARGS_SHA256,
    { 0 }
};

static const WrArgSpec args_normals[] = {
    { .name = "FILE|off",
      .type = WR_ARG_PATH,
      .positional = true,
      .words = none_words,
      .help = "a picture of normals, or off (none is off too; a file of that name is ./off). Left "
              "out: the one that is there, of which strength, repeat, space, frame and green may "
              "change" },
    { .name = "space",
      .type = WR_ARG_CHOICE,
      .words = spaces,
      .fallback_text = "tangent",
      .help = "tangent: x along u, y along v, z up; object: along the object's axes. Without a "
              "file the vectors that are there are taken so" },
    { .name = "frame",
      .type = WR_ARG_CHOICE,
      .words = wr_normal_frame_names,
      .fallback_text = "auto",
      .help = "which way x and y run. gradient: they make slopes of heights over a cell of one "
              "unit, as the table's; mikk: unit vectors by the rules of MikkTSpace, as other "
              "programs bake; lecture: unit vectors along Pu and Pv; auto: mikk on a mesh, else "
              "gradient" },
    { .name = "green",
      .type = WR_ARG_CHOICE,
      .words = greens,
      .fallback_text = "auto",
      .help = "which way its second number runs: up the picture, down, or as its label or its "
              "slopes tell" },
    { .name = "channels",
      .type = WR_ARG_CHOICE,
      .words = channel_counts,
      .fallback_text = "auto",
      .help = "3: all are read; 2: z is rebuilt from x and y; auto: as many as there are" },
    { .name = "coding",
      .type = WR_ARG_CHOICE,
      .words = wr_codings,
      .fallback_text = "auto",
      .help =
          "of floats: unit: 0..1 stands for -1..1; signed: the vectors' own numbers; auto: what "
          "is nearer to vectors of length 1" },
    { .name = "strength",
      .type = WR_ARG_NUMBER,
      .low = -100,
      .high = 100,
      .help = "its slopes times this. Of a new map: 1" },
    WR_ARGS_REPEAT,
    WR_ARGS_OF_FILE,
    WR_ARGS_SHA256,
    { 0 }
};

const WrCommand wr_command_colour = {
    .name = "colour",
    .kind = WR_CLASS_SCENE,
    .args = args_colour,
    .run = run_colour,
    .print = print_colour,
    .print_content = print_colour_content,
    .of_object = true,
    .help = "a colour picture on the surface",
    .details =
        "8-bit and 16-bit pictures are decoded from sRGB, float ones taken as linear; alpha is "
        "left out. Beyond its ends it goes on as the table does. Under dials aa=filter and "
        "aa=moments each pixel has the mean of what it covers of the picture. It is saved inside "
        "the document.",
    .example = "colour peel.png repeat=once"
};

const WrCommand wr_command_normalmap = {
    .name = "normalmap",
    .kind = WR_CLASS_SCENE,
    .args = args_normals,
    .run = run_normals,
    .print = print_normals,
    .print_content = print_normals_content,
    .of_object = true,
    .help = "a normal map on the surface",
    .details =
        "Its slopes are added to those of the table. What `export normal` writes of a table with "
        "cell=1,1 turns the normal as the table does. A picture of normals is data, and never "
        "colour-converted; 8-bit and 16-bit codes are 2 c/M - 1, float numbers by coding. "
        "Where most texels are 128,128 "
        "(32768 of 16 bits) that code stands for 0. A note tells what was taken. Beyond its ends "
        "it goes on as the table does. It is saved inside the document.",
    .example = "normalmap rivets.png green=down strength=1"
};
