"""What launch files would start, for tests of them."""

import os

import roslaunch
import rospkg

PACKAGE = rospkg.RosPack().get_path('scan_image_slam')


def load(file_name, **arguments):
    """What roslaunch would start, and with which parameters."""
    path = os.path.join(PACKAGE, 'launch', file_name)
    words = [f'{key}:={value}' for key, value in arguments.items()]
    return roslaunch.config.load_config_default([(path, words)], None, verbose=False)


def stand_in(folder, package, program):
    """A package of that name, with a program that does nothing."""
    os.mkdir(os.path.join(folder, package))
    with open(os.path.join(folder, package, 'package.xml'), 'w') as file:
        file.write('<package><name>%s</name><version>0.0.0</version><description/>'
                   '<maintainer email="a@b.invalid">a</maintainer><license>none</license>'
                   '</package>' % package)
    if program:
        path = os.path.join(folder, package, program)
        with open(path, 'w') as file:
            file.write('#!/bin/sh\n')
        os.chmod(path, 0o755)


def types(config):
    return {(node.package, node.type) for node in config.nodes}


def remaps(config, name):
    """Of a node, without leading slashes."""
    node = next(node for node in config.nodes if node.name == name)
    return {key.lstrip('/'): to.lstrip('/') for key, to in node.remap_args}


def value(config, name):
    return config.params[name].value
