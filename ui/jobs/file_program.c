#include "ui/jobs/file_program.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/child.h"
#include "system/fd.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

static char *find_program(const char *name)
{
    const char *path = getenv("PATH");
    while (path && *path) {
        size_t length = strcspn(path, ":");
        char *folder = wr_strndup(path, length), *full = wr_path_join(folder, name);
        wr_free(folder);
        if (length > 0 && wr_path_can_run(full)) return full;
        wr_free(full);
        path += length + (path[length] == ':');
    }
    return NULL;
}

/* Read the answer: one path on one line. */
void wr_file_program_hear(WrPid child, int pipe, char *answer, size_t size)
{
    size_t length = 0;
    for (;;) {
        int64_t got = wr_fd_read(pipe, answer + length, size - 1 - length);
        if (got <= 0) break;
        length += (size_t)got;
        if (length == size - 1) break;
    }
    WrChildEnd end;
    wr_child_wait(child, &end);
    while (length > 0 && answer[length - 1] == '\n') length--;
    bool chosen = end.why == WR_CHILD_LEFT && end.number == 0 && length > 0 && answer[0] == '/';
    answer[chosen ? length : 0] = '\0';
}

void wr_file_program_dismiss(WrPid child)
{
    WrChildEnd end;
    wr_child_ask_to_end(child);
    wr_child_wait(child, &end);
}

static bool start(const char *program, const char *const *arguments, WrPid *child, int *pipe)
{
    int ends[2];
    if (!wr_fd_pipe(ends, true)) return false;
    const WrChildStart it = {
        .program = program, .arguments = arguments, .in = -1, .out = ends[1], .err = -1
    };
    const int trouble = wr_child_start(&it, child);
    wr_fd_close(ends[1]);
    *pipe = ends[0];
    if (trouble != 0) wr_fd_close(ends[0]);
    return trouble == 0;
}

bool wr_file_program_start(const char *title, bool save, const char *start_at, WrPid *child,
                           int *pipe)
{
    char *zenity = find_program("zenity"), *kdialog = zenity ? NULL : find_program("kdialog");
    bool ok = false;
    if (zenity) {
        WrText where = { 0 }, named = { 0 };
        wr_text_addf(&where, "--filename=%s", start_at);
        wr_text_addf(&named, "--title=%s", title);
        const char *arguments[] = { zenity,
                                    "--file-selection",
                                    wr_text_get(&named),
                                    wr_text_get(&where),
                                    save ? "--save" : NULL,
                                    "--confirm-overwrite",
                                    NULL };
        ok = start(zenity, arguments, child, pipe);
        wr_text_fini(&where);
        wr_text_fini(&named);
    } else if (kdialog) {
        /* The program itself asks before it returns the name of an existing file. */
        const char *arguments[] = { kdialog,  "--title",
                                    title,    save ? "--getsavefilename" : "--getopenfilename",
                                    start_at, NULL };
        ok = start(kdialog, arguments, child, pipe);
    }
    wr_free(zenity);
    wr_free(kdialog);
    return ok;
}
