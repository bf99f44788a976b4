/* A file portal for tests by a script: prints the address of its bus. The path that it answers with is the first line of
   the file `answer` in the current folder; requests are in `asked`. Ends with the process that started it. */
#include "test.h"

#include "portal_help.h"

int main(void)
{
    const Act act = { .replies = true, .file = "answer" };
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (!start_bus()) return 1;
    const pid_t portal = start_portal(&act);
    printf("%s\n", getenv("DBUS_SESSION_BUS_ADDRESS"));
    fflush(stdout);
    waitpid(portal, NULL, 0);
    return 0;
}
