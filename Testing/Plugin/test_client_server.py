"""The plugin on a server of its own: proxies, properties and both ports work through the network."""
import socket
import subprocess

from bsrtesting import *

with socket.socket() as s:
    s.bind(("127.0.0.1", 0))
    port = s.getsockname()[1]
server = subprocess.Popen(
    ["pvserver", "--server-port=%d" % port, "--hostname=127.0.0.1"],
    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
try:
    for line in server.stdout:
        if "Accepting connection" in line:
            break
    else:
        skip("pvserver does not start")
    Connect("127.0.0.1", port)
    load_plugin(remote=True)
    load_plugin(remote=False)
    f = FiberPhantom(Dimensions=[64, 32, 32], Seed=2, OpenEnds=0)
    check(f.GetClientSideObject() is None, "the filter is on the server")
    check_equal(fetch(f, 0).GetDimensions(), (64, 32, 32), "dimensions")
    check_equal(set(array(fetch(f, 1), "End")), {0}, "ends of a closed fiber")
    m = Median(Input=OutputPort(f, 0))
    check_equal(list(m.Scalars), ["POINTS", "CT"], "default array")
    check_equal(fetch(m).GetDimensions(), (64, 32, 32), "dimensions after Median")
    Delete(m)
    Delete(f)
    Disconnect()
finally:
    server.kill()
    server.wait()
