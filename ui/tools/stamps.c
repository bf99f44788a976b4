/* Pictures of the stamp tool: those in the brush folders that are not thumbnails of presets. */
#include "ui/tools/stamps.h"
#include "ui/state/app_state.h"
#include "ui/tools/tool_stamp.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "brush/library.h"
#include "system/path.h"

#include <SDL.h>
#include <stdlib.h>
#include <string.h>

#define DEPTH_MAX 3     /* depth of nested folders */
#define STAMPS_MAX 2000 /* limit for all folders */

static bool has_ending(const char *name, const char *ending)
{
    size_t n = strlen(name), m = strlen(ending);
    return n > m && SDL_strcasecmp(name + n - m, ending) == 0;
}

static bool is_picture(const char *name)
{
    static const char *const endings[] = {
        ".png", ".gbr", ".gih", ".jpg", ".tif", ".tiff", ".exr"
    };
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (has_ending(name, endings[i])) return true;
    return false;
}

/* NAME.png beside NAME.myb, or NAME_prev.png, is the thumbnail of a preset. */
static bool is_thumbnail(const char *folder, const char *name)
{
    const char *dot = strrchr(name, '.');
    size_t length = (size_t)(dot - name);
    if (length > 5 && strncmp(dot - 5, "_prev", 5) == 0) return true;
    WrText preset = { 0 };
    wr_text_addf(&preset, "%s/%.*s.myb", folder, (int)length, name);
    bool there = wr_path_is_there(wr_text_get(&preset));
    wr_text_fini(&preset);
    return there;
}

static int by_name(const void *a, const void *b)
{
    char *const *x = a, *const *y = b;
    return SDL_strcasecmp(*x, *y);
}

typedef WR_ARRAY(char *) Names; /* owned */

static Names list_folder(const char *path)
{
    Names names = { 0 };
    WrFolder *folder = wr_folder_open(path);
    for (const char *name; folder && (name = wr_folder_next(folder));)
        if (name[0] != '.') wr_array_push(&names, wr_strdup(name));
    wr_folder_close(folder);
    if (names.count > 1) qsort(names.data, (size_t)names.count, sizeof *names.data, by_name);
    return names;
}

static void search(WrApp *app, const char *folder, int depth)
{
    Names names = list_folder(folder);
    for (int i = 0; i < names.count; i++) {
        const char *name = names.data[i];
        char *path = wr_path_join(folder, name);
        bool folder_too = wr_path_is_folder(path);
        if (folder_too && depth < DEPTH_MAX) search(app, path, depth + 1);
        bool takes = !folder_too && is_picture(name) && !is_thumbnail(folder, name) &&
                     app->stamp->stamps.count < STAMPS_MAX;
        if (takes) wr_array_push(&app->stamp->stamps, path);
        else wr_free(path);
        wr_free(names.data[i]);
    }
    wr_array_free(&names);
}

void wr_stamps_find(WrApp *app)
{
    WrText ours = { 0 };
    WrError err;
    if (app->stamp->stamps_known) return;
    app->stamp->stamps_known = true;
    char *user = wr_library_user_folder(&err);
    if (user) search(app, user, 0);
    wr_free(user);
    if (wr_data_find("brushes", &ours)) search(app, wr_text_get(&ours), 0);
    wr_text_fini(&ours);
    search(app, "/usr/share/gimp/2.0/brushes", 0);
}

void wr_stamps_free(WrApp *app)
{
    for (int i = 0; i < app->stamp->stamps.count; i++) wr_free(app->stamp->stamps.data[i]);
    wr_array_free(&app->stamp->stamps);
}
