/* A run on Arm's MPS2 in QEMU: start-up, the files `input` and `output` through semihosting, and TIMER0 as a counter of
 * instructions, as firmware/src/board/cmsdk_timer.rs has it. */
#include "run.h"

extern uint32_t stack_top, data_start, data_end, data_load, bss_start, bss_end;

#define TIMER ((volatile uint32_t *)0x40000000)
#define CPACR (*(volatile uint32_t *)0xE000ED88)

static int in, out;

static int semihosting(int operation, const void *arguments)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = arguments;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static int open(const char *name, uint32_t length, uint32_t mode)
{
    const uint32_t arguments[] = { (uint32_t)name, mode, length };
    return semihosting(1, arguments);
}

int receive(void *bytes, size_t size)
{
    const uint32_t arguments[] = { (uint32_t)in, (uint32_t)bytes, size };
    return semihosting(6, arguments) == 0;
}

int send(const void *bytes, size_t size)
{
    const uint32_t arguments[] = { (uint32_t)out, (uint32_t)bytes, size };
    return semihosting(5, arguments) == 0;
}

uint32_t count(void) { return ~TIMER[1]; }
/* 40 ns a count, 1024 ns an instruction */
uint32_t instructions(uint32_t counts) { return (counts * 40 + 512) / 1024; }

void reset(void);
void reset(void)
{
    CPACR |= 0xFu << 20;
    __asm__ volatile("dsb\n\tisb");
    for (uint32_t *to = &data_start, *from = &data_load; to < &data_end;) *to++ = *from++;
    for (volatile uint32_t *to = &bss_start; to < &bss_end;) *to++ = 0;
    TIMER[0] = 0;
    TIMER[2] = UINT32_MAX;
    TIMER[1] = UINT32_MAX;
    TIMER[0] = 1;
    in = open("input", 5, 1);
    out = open("output", 6, 5);
    /* ADP_Stopped_ApplicationExit, or a run-time error */
    semihosting(0x18, (const void *)(in >= 0 && out >= 0 && run() == 0 ? 0x20026u : 0x20023u));
    for (;;) {}
}

__attribute__((section(".vectors"), used)) static const void *const vectors[] = { &stack_top, (const void *)reset };
