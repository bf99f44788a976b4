#include "ui/canvas/tools/script_list.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

#define TITLE_MAX 512 /* bytes of a first line */

static void add(WrScriptList *list, const char *folder, const char *name)
{
    char line[TITLE_MAX], *path = wr_path_join(folder, name);
    const int stem = (int)(strlen(path) - strlen(".wrinkle"));
    WrText picture = { 0 };
    wr_text_addf(&picture, "%.*s.png", stem, path);
    if (!wr_path_is_there(wr_text_get(&picture))) {
        wr_text_clear(&picture);
        wr_text_addf(&picture, "%.*s.jpg", stem, path);
    }
    line[wr_file_peek(path, line, sizeof line - 1)] = '\0';
    line[strcspn(line, "\n")] = '\0';
    char *title = line + strspn(line, "# "), *words = strchr(title, ':');
    if (words) {
        *words++ = '\0';
        words += strspn(words, " ");
    }
    wr_array_push(&list->scripts, ((WrScript){ path, wr_strdup(wr_text_get(&picture)),
                                               wr_strdup(title), wr_strdup(words ? words : "") }));
    wr_text_fini(&picture);
}

static int by_title(const void *a, const void *b)
{
    const WrScript *x = a, *y = b;
    return strcmp(x->title, y->title);
}

void wr_script_list_find(WrScriptList *list, const char *folder)
{
    WrText path = { 0 };
    char ending[16];
    if (list->known) return;
    list->known = true;
    WrFolder *open = wr_data_find(folder, &path) ? wr_folder_open(wr_text_get(&path)) : NULL;
    for (const char *name; open && (name = wr_folder_next(open));)
        if (strcmp(wr_path_ending(name, ending), "wrinkle") == 0)
            add(list, wr_text_get(&path), name);
    wr_folder_close(open);
    wr_text_fini(&path);
    if (list->scripts.count > 1)
        qsort(list->scripts.data, (size_t)list->scripts.count, sizeof *list->scripts.data,
              by_title);
}

void wr_script_list_free(WrScriptList *list)
{
    for (int i = 0; i < list->scripts.count; i++) {
        wr_free(list->scripts.data[i].path);
        wr_free(list->scripts.data[i].picture);
        wr_free(list->scripts.data[i].title);
        wr_free(list->scripts.data[i].words);
    }
    wr_array_free(&list->scripts);
    list->known = false;
}
