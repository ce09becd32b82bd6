"""The house rules for the proxies in xml/: what a person sees of every filter of the plugin."""
import glob
import re
import xml.etree.ElementTree as ElementTree

from bsrtesting import *

PROPERTIES = ("IntVectorProperty", "DoubleVectorProperty", "StringVectorProperty", "IdTypeVectorProperty")
problems = []


def complain(condition, *what):
    if not condition:
        problems.append(" ".join(what))


def spaced(name):
    """CamelCase to spaced words; runs of capitals stay together."""
    words = re.findall(r"[A-Z]+(?![a-z])|[A-Z][a-z]*|\d+|[a-z]+", name)
    return " ".join(words)


def text_of(element):
    d = element.find("Documentation")
    if d is None:
        return ""
    return " ".join(filter(None, [d.text, d.get("short_help"), d.get("long_help")])).strip()


def check_property(proxy, p):
    name = proxy.get("name") + "." + p.get("name")
    internal = p.get("panel_visibility") == "never" or p.get("information_only") == "1"
    if not internal:
        complain(text_of(p), name, "has no documentation")
        complain(p.get("label") or spaced(p.get("name")) == p.get("name"), name, "has no label")


def check_proxy(group, proxy):
    name = proxy.get("name")
    complain(text_of(proxy), name, "has no documentation")
    hints = proxy.find("Hints")
    writer = proxy.tag in ("WriterProxy", "PWriterProxy")
    menu = None if hints is None else hints.find("ShowInMenu")
    if not writer:
        complain(menu is not None and menu.get("category") == "B-Spline Reconstruction", name, "is not in the menu")
        constructor = re.sub(r"[^A-Za-z0-9_]", "", proxy.get("label", name))
        complain(hasattr(servermanager.filters if group == "filters" else servermanager.sources, constructor),
                 name, "cannot be made in Python as", constructor)
    shown = [p for p in proxy if p.tag in PROPERTIES and p.get("panel_visibility", "default") == "default"
             and p.get("information_only") != "1" and p.find("ArrayListDomain") is None]
    complain(len(shown) <= 5, name, "shows %d properties" % len(shown), str([p.get("name") for p in shown]))
    for p in proxy:
        if p.tag in PROPERTIES:
            check_property(proxy, p)
    ports = proxy.findall("OutputPort")
    page = os.path.join(SOURCE_DIR, "Documentation", name + ".md")
    if not os.path.exists(page):
        print("note: %s has no page in Documentation" % name)
    for port in ports:
        complain(port.get("name"), name, "has a port without a name")


count = 0
for path in sorted(glob.glob(os.path.join(SOURCE_DIR, "xml", "*.xml"))):
    for group in ElementTree.parse(path).getroot().iter("ProxyGroup"):
        if group.get("name") in ("filters", "sources", "writers"):
            for proxy in group:
                count += 1
                check_proxy(group.get("name"), proxy)
                complain(proxy.get("name") == os.path.splitext(os.path.basename(path))[0], path,
                         "holds the proxy", str(proxy.get("name")))
check(count > 5, "there are proxies")
check(not problems, "\n" + "\n".join(problems))
