"""x"""
def figures(found): return {}
def page(found): return ""
