"""A link between two network namespaces that takes its time, for kernels without `netem`.

    python3 delayed_link.py NAMESPACE_A NAMESPACE_B DELAY_IN_SECONDS BITS_PER_SECOND

Makes a device `wire` in each namespace and passes packets on between them, each after the time that its bits take and
the delay. Says `ready` once both are there. Ends when its standard input does, and the devices with it.
"""

import collections
import ctypes
import fcntl
import os
import select
import struct
import subprocess
import sys
import time

TUNSETIFF, TUN_WITHOUT_HEADER = 0x400454CA, 0x1001
PR_SET_TIMERSLACK = 29
# Of what is on the way, in packets: what is more is lost, as in a switch.
ROOM = 2000

names, (delay, rate) = sys.argv[1:3], map(float, sys.argv[3:5])
ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, 1000, 0, 0, 0)

ends = []
for side, name in zip("ab", names):
    end = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    device = f"wire{os.getpid()}{side}"
    fcntl.ioctl(end, TUNSETIFF, struct.pack("16sH22x", device.encode(), TUN_WITHOUT_HEADER))
    subprocess.run(["ip", "link", "set", device, "netns", name, "name", "wire"], check=True)
    subprocess.run(["ip", "-n", name, "link", "set", "wire", "mtu", "9000"], check=True)
    ends.append(end)
print("ready", flush=True)

under_way = [collections.deque(), collections.deque()]
free_at = [0.0, 0.0]
while True:
    now = time.monotonic()
    due = [queue[0][0] for queue in under_way if queue]
    wait = max(0.0, min(due) - now) if due else None
    readable = select.select([*ends, sys.stdin], [], [], wait)[0]
    if sys.stdin in readable:
        sys.exit()
    for side, end in enumerate(ends):
        for _ in range(16 if end in readable else 0):
            try:
                packet = os.read(end, 65536)
            except OSError:  # no more, or the device is down
                break
            if len(under_way[side]) < ROOM:
                free_at[side] = max(free_at[side], time.monotonic()) + 8 * len(packet) / rate
                under_way[side].append((free_at[side] + delay, packet))
    now = time.monotonic()
    for side, queue in enumerate(under_way):
        while queue and queue[0][0] <= now:
            try:
                os.write(ends[1 - side], queue.popleft()[1])
            except OSError:  # the other end is down: lost
                pass
