/* No sandbox: POSIX limits do not keep a process from files or other processes. So untrusted files are
   rejected with the reason, unless the user accepts the risk of reading them
   inside the program (WRINKLE_READER=inside). Files just written by the program are read back inside
   it. Other systems have better mechanisms: sandbox_init on macOS, pledge on OpenBSD, cap_enter on
   FreeBSD; their sandbox would be a file like this one. */
#include "system/sandbox.h"

#include "system/process.h"

uint64_t wr_sandbox_space(void)
{
    return wr_process_space();
}

void wr_sandbox_memory(uint64_t space, uint64_t memory)
{
    if (memory > 0 && space > 0) wr_process_limit(WR_LIMIT_SPACE, space + memory);
}

void wr_sandbox_limit(uint64_t memory, unsigned seconds)
{
    wr_process_limit(WR_LIMIT_CORE, 0);
    wr_process_limit(WR_LIMIT_FILE, 0);
    wr_process_limit(WR_LIMIT_FILES, 64);
    if (seconds > 0) wr_process_limit_time(seconds);
    wr_sandbox_memory(wr_sandbox_space(), memory);
}

void wr_sandbox_close_files(void)
{
}

bool wr_sandbox_filter_calls(void)
{
    return false;
}

bool wr_sandbox_enter(uint64_t memory, unsigned seconds)
{
    wr_sandbox_limit(memory, seconds);
    return false;
}
