/* Standard output as the place of a file, and receipts. */
#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/cli.h"
#include "export/receipt.h"
#include "system/path.h"
#include "system/process.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

bool wr_cli_to_stdout(const WrCli *cli)
{
    return cli->out && (strcmp(cli->out, "-") == 0 || strcmp(cli->out, "/dev/stdout") == 0);
}

int wr_cli_report(const WrCli *cli, const WrText *text)
{
    if (!cli->shown) return wr_cli_print(cli, text);
    wr_cli_progress_clear();
    fputs(wr_text_get(text), stderr);
    return WR_EXIT_DONE;
}

bool wr_cli_add_receipt(const WrCli *cli, const WrReceipt *receipt, WrText *text, WrError *err)
{
    return wr_receipt_json(receipt, cli->file, cli->shown, text, err);
}

/* Counts the files of a folder. */
static int count_files(const char *path)
{
    int count = 0;
    WrFolder *folder = wr_folder_open(path);
    while (folder && wr_folder_next(folder)) count++;
    wr_folder_close(folder);
    return count;
}

#define PIPE_BYTES 65536

static bool copy_bytes(const WrCli *cli, const char *path, WrError *err)
{
    char bytes[PIPE_BYTES], why[WR_FILE_WHY];
    int64_t count;
    const int fd = wr_file_open(path, WR_FILE_MAX, NULL, err);
    if (fd < 0) return false;
    bool good = true;
    while (good && (count = wr_fd_read(fd, bytes, sizeof bytes)) != 0) {
        if (count < 0) good = wr_fail(err, "%s: cannot be read (%s)", path, strerror(errno));
        else if (!wr_fd_write(WR_FD_OUT, bytes, (size_t)count))
            good = errno == EPIPE
                       ? wr_fail(err, "standard output: the program that reads it has ended")
                       : wr_fail(err, "standard output: could not be written (%s)",
                                 wr_file_why(errno, why));
        if (good && wr_cancel_requested(cli->cancel)) good = wr_fail(err, "cancelled");
    }
    wr_fd_close(fd);
    return good;
}

/* Libraries write only to files that can be read back, so the bytes of a pipe come from one. */
int wr_cli_pipe(const WrCli *cli, const char *ending, int (*work)(const WrCli *cli))
{
    WrError err;
    WrCli one = *cli;
    char *folder = wr_scratch_new(&err);
    if (!folder) return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    WrText path = { 0 };
    wr_text_addf(&path, "%s/out.%s", folder, ending);
    one.out = wr_text_get(&path);
    one.shown = "-";
    wr_process_outlive_pipes();
    int status = work(&one);
    const int count = status == WR_EXIT_DONE ? count_files(folder) : 1;
    if (count != 1) {
        wr_fail(&err, "-o -: these are %d files, and standard output holds one: name a file",
                count);
        status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    } else if (status == WR_EXIT_DONE && !copy_bytes(cli, one.out, &err)) {
        status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    wr_scratch_free(folder);
    wr_text_fini(&path);
    return status;
}
