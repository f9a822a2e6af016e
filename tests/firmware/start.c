/* SPDX-License-Identifier: MIT */
/* From reset to main() on a Cortex-M4F that talks through semihosting. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

extern char stack_top[], data_image[], data_begin[], data_end[], bss_begin[],
    bss_end[]; /* of the linker script */

extern int main(void);
extern void initialise_monitor_handles(void); /* newlib's semihosting */
void start(void);

#define COPROCESSOR_ACCESS (*(volatile uint32_t*)0xe000ed88u)

void start(void) {
  COPROCESSOR_ACCESS |= 0xfu << 20; /* floating point, before its first use */
  __asm volatile("dsb\n\tisb");
  memcpy(data_begin, data_image, (size_t)(data_end - data_begin));
  memset(bss_begin, 0, (size_t)(bss_end - bss_begin));
  initialise_monitor_handles();
  exit(main());
}

static void fault(void) { abort(); }

/* exit() asks for them. */
void _init(void);
void _fini(void);
void _init(void) {}
void _fini(void) {}

struct vector_table {
  char* stack;
  void (*handlers[15])(void);
};

__attribute__((section(".vectors"),
               used)) static const struct vector_table vectors = {
    stack_top, {start, fault, fault, fault, fault, fault}};
