#include "cli/program/interrupt.hpp"

#include <csignal>

#include "photo/system/system.hpp"

namespace lensprof {
namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

void on_signal(int number) {
    interrupt_flag = 1;
    std::signal(number, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    system::survive_size_limits();
}

bool interrupted() { return interrupt_flag != 0; }

}  // namespace lensprof
